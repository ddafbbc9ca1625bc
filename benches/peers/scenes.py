"""The scenes that peers are asked, and what their answers should be.

Scenes at rest are read from assets/scenes, motions are those of benches/src/motion.rs. References
at rest come from the program of this project (`cable solve --json`), those of motions from
`exact` in motion.rs or from docs/convergence.md.
"""

import json
import math
import os
import subprocess
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
GRAVITY = 9.80665

AT_REST = {
    "hanging-span": "catenary",
    "near-taut": "catenary",
    "steep-span": "catenary",
    "loads-wind-heat": "catenary",
    "slack-to-floor": "spans",
    "over-beam": "spans",
    "round-post": "spans",
    "pulley-waypoints": "spans",
}
IN_MOTION = ["swing", "fold", "free-fall", "drop", "snap", "drag", "capstan-half"]


@dataclass
class Rest:
    """A scene at rest: one cable, its supports, loads and obstacles, in plain numbers."""

    id: str
    length_m: float
    density_kg_per_m: float
    axial_stiffness_n: float
    diameter_m: float
    # The load on each metre of unstretched cable, N/m: weight and wind.
    load_n_per_m: np.ndarray
    # The strain that heat alone would give.
    heat_strain: float
    # (name, kind, place in m), from start to end.
    supports: list
    # (arc length in m, force in N).
    loads: list
    obstacles: list
    route_m: list
    reference: dict = field(repr=False)

    @property
    def ends(self):
        """Both ends, m."""
        return np.array(self.supports[0][2]), np.array(self.supports[-1][2])

    @property
    def warm(self):
        """Length, stiffness and load of the same cable with its heat strain taken as natural.

        The stretch of a cable that heat has strained by a is (1 + a)(1 + T/EA) here, as in the
        reference; another convention would differ in the seventh digit.
        """
        a = 1.0 + self.heat_strain
        return self.length_m * a, self.axial_stiffness_n, self.load_n_per_m / a

    def place(self, arc_m):
        """Where material points are, m: cubics between nodes of the reference."""
        r = self.reference
        s, x, t = r["arc_m"], r["place_m"], r["slope"]
        at = np.clip(np.atleast_1d(np.asarray(arc_m, float)), s[0], s[-1])
        k = np.clip(np.searchsorted(s, at, side="right") - 1, 0, len(s) - 2)
        h = s[k + 1] - s[k]
        u = ((at - s[k]) / h)[:, None]
        h = h[:, None]
        chord, a, b = x[k + 1] - x[k], h * t[k], h * r["slope_before"][k + 1]
        # A kink at an eye: the slope of its node is that of the cable beyond it.
        kink = (a * b).sum(1) < 0.97 * np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
        b[kink] = 2.0 * chord[kink] - a[kink]
        return x[k] + u * (a + u * ((3 * chord - 2 * a - b) + u * (a + b - 2 * chord)))

    def errors(self, forces_n, greatest_n, arc_m=None, place_m=None):
        """Error of forces and greatest tension, and error of shape (or None).

        `forces_n` are the forces of the cable on its supports, from start to end.
        """
        r = self.reference
        scale = r["greatest_n"]
        off = np.linalg.norm(np.asarray(forces_n, float) - r["forces_n"], axis=1)
        error = max(off.max(), abs(greatest_n - scale)) / scale
        if arc_m is None:
            return error, None
        away = np.linalg.norm(np.asarray(place_m, float) - self.place(arc_m), axis=1)
        return error, away.max() / self.length_m


def program():
    """The built program of this project."""
    named = os.environ.get("CABLE")
    found = [named] if named else [ROOT / "target" / p / "cable" for p in ("release", "debug")]
    for path in found:
        if Path(path).exists():
            return str(path)
    raise SystemExit("no program: build it (cargo build --release) or set CABLE to its path")


def reference(scene_path, model, heat_strain, stiffness_n):
    """The answer of this project's program to a scene."""
    command = [program(), "solve", str(scene_path), "--json", "--model", model]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    answer = json.loads(out.splitlines()[0])
    arc, place, slope, before = [], [], [], []
    for node in answer["nodes"]:
        # Two nodes of one place lie before and after a load.
        twice = bool(arc) and node["arc_length_m"] <= arc[-1]
        force = np.array(node["force_n"])
        pull = np.linalg.norm(force)
        along = force / pull * (1.0 + heat_strain) * (1.0 + pull / stiffness_n)
        if twice:
            slope[-1] = along
            continue
        arc.append(node["arc_length_m"])
        place.append([node["x_m"], node["y_m"]])
        slope.append(along)
        before.append(along)
    supports = answer["supports"]
    return {
        "greatest_n": answer["max_tension_n"],
        "forces_n": np.array([[s["reaction_x_n"], s["reaction_y_n"]] for s in supports]),
        "arc_m": np.array(arc),
        "place_m": np.array(place),
        "slope": np.array(slope),
        "slope_before": np.array(before),
    }


def rest(scene_id):
    """A scene at rest with its reference."""
    path = ROOT / "assets/scenes" / f"{scene_id}.toml"
    scene = tomllib.loads(path.read_text())
    cable = scene["cables"][0]
    preset = tomllib.loads((ROOT / "assets/cables" / f"{cable['preset']}.toml").read_text())
    value = lambda key: cable.get(key, preset[key]["value"])
    around = scene.get("environment", {})
    heat = value("thermal_expansion_per_k") * around.get("temperature_change_k", 0.0)
    density = value("linear_density_kg_per_m")
    load = np.array(around.get("wind_n_per_m", [0.0, 0.0])) - [0.0, density * GRAVITY]
    stiffness = value("axial_stiffness_n")
    return Rest(
        id=scene_id,
        length_m=cable["length_m"],
        density_kg_per_m=density,
        axial_stiffness_n=stiffness,
        diameter_m=value("diameter_m"),
        load_n_per_m=load,
        heat_strain=heat,
        supports=[(s["name"], s["kind"], s["at_m"]) for s in cable["supports"]],
        loads=[(p["arc_length_m"], np.array(p["force_n"])) for p in scene.get("loads", [])],
        obstacles=scene.get("obstacles", []),
        route_m=cable.get("route_m", []),
        reference=reference(path, AT_REST[scene_id], heat, stiffness),
    )


def calkin_march_s(length_m=10.0, fallen_m=6.0):
    """Time in which the end of a folded chain falls (M. G. Calkin, R. H. March, 1989), s."""
    n = 2000
    h = math.sqrt(fallen_m) / n
    u = (np.arange(n) + 0.5) * h
    rest_m = length_m - u * u
    return float(np.sum(h * 2.0 * np.sqrt(rest_m / (GRAVITY * (length_m + rest_m)))))


def folded(n, length_m=10.0):
    """Places of the n + 1 nodes of a folded chain: half down, a link across, half up."""
    down = (n - 1) // 2
    steps = [[0, -1] if j < down else [1, 0] if j == down else [0, 1] for j in range(n)]
    return np.vstack([[0.0, 0.0], np.cumsum(np.array(steps, float) * length_m / n, axis=0)])


# Where the tip of a chain of 10 m is 1 s after it is let go level, m (docs/convergence.md).
SWING_TIP_M = np.array([7.535642, -4.903325])
# The mean pull at the hand of floor-drag from 4 s to 6 s, N (docs/convergence.md).
DRAG_PULL_N = 36.207355
FOLD_S = calkin_march_s()
# A cable of 10 m lets go of both ends after so long, s.
LET_GO_S = 0.01
FREE_FALL_M = 0.5 * GRAVITY * (0.5 - LET_GO_S) ** 2
# A mass of 100 kg, fallen 2 m, on a rope of 10 m without weight: its greatest pull, N.
SNAP_MASS_KG, SNAP_EA_N, SNAP_SPEED = 100.0, 2e4, math.sqrt(2.0 * GRAVITY * 2.0)
_W = SNAP_MASS_KG * GRAVITY
SNAP_PULL_N = _W * (1.0 + math.sqrt(1.0 + 2.0 * 2.0 * SNAP_EA_N / (_W * 10.0)))
# A cord with a weight of 5.4 N round half a turn of a rod whose friction is 0.2: pull over weight.
HUNG_N, RUBS = 5.4, 0.2
CAPSTAN_RATIO = math.exp(RUBS * math.pi)


def smooth(u):
    """A step from 0 to 1 that begins and ends without speed and acceleration, and its slope."""
    u = min(max(u, 0.0), 1.0)
    return u**3 * (10.0 - 15.0 * u + 6.0 * u * u), 30.0 * (u * (1.0 - u)) ** 2


def hand_of_drag(t):
    """Place and speed of the hand of floor-drag along x, m: on its way from 1 s to 9 s."""
    part, slope = smooth((t - 1.0) / 8.0)
    return 6.0 + 6.0 * part, 6.0 * slope / 8.0


def hand_of_capstan(t):
    """How far the hand of the capstan has gone, and its speed, m: 0.05 m within 2 s."""
    part, slope = smooth(t / 2.0)
    return 0.05 * part, 0.05 * slope / 2.0


def crossing(times, depths, wanted):
    """When a depth is first reached, linear between the steps."""
    for k, depth in enumerate(depths):
        if depth >= wanted:
            if k == 0:
                return times[0]
            part = (depth - wanted) / (depth - depths[k - 1])
            return times[k] - part * (times[k] - times[k - 1])
    return math.nan


def greatest(pulls):
    """The greatest of a row of pulls, by a parabola through three: it lies between two steps."""
    best = 0.0
    for a, b, c in zip(pulls, pulls[1:], pulls[2:]):
        if b >= a and b >= c and 2.0 * b > a + c:
            best = max(best, b + 0.125 * (c - a) ** 2 / (2.0 * b - a - c))
    return best


def hung(span_m, length_m, density, stiffness_n, n):
    """Nodes of a cable that hangs between two level ends: the elastic catenary by its own formula."""
    from scipy.optimize import brentq

    w = density * GRAVITY
    v = 0.5 * w * length_m

    def x(h, s):
        f = w * s - v
        return h * s / stiffness_n + h / w * (math.asinh(f / h) + math.asinh(v / h))

    def y(h, s):
        f = w * s - v
        return s * (0.5 * w * s - v) / stiffness_n + (math.hypot(h, f) - math.hypot(h, v)) / w

    h = brentq(lambda h: x(h, length_m) - span_m, 1e-6 * v, 1e4 * v, xtol=1e-13)
    arcs = np.linspace(0.0, length_m, n + 1)
    return arcs, np.array([[x(h, s), y(h, s)] for s in arcs])
