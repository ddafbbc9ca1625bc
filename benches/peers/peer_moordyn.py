"""MoorDyn: lumped masses, explicit; at rest by its stationary solver of initial conditions."""

import math
import os
import tempfile

import moordyn
import numpy as np

import scenes
from measure import Point, cannot, least
from scenes import IN_MOTION, rest

INPUT = """--- MoorDyn input ---
made by benches/peers
--- LINE TYPES ---
TypeName Diam MassDenInAir EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
cable {diameter} {density} {stiffness} {damping} 0 0 0 0 0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (mm^3) (m^2) (-)
1 {first} {ax} 0 {az} 0 0 0 0
2 {last} {bx} 0 {bz} {mass} 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(#) (name) (#) (#) (m) (-) (-)
1 cable 1 2 {length} {n} -
--- OPTIONS ---
0 writeLog
{dt} dtM
{kb} kb
{cb} cb
0 WtrDnsty
9.80665 g
{depth} WtrDpth
{threshold} threshIC
{most_s} TmaxIC
{friction} FrictionCoefficient
{friction} frictionCoefficient
{scheme} tScheme
--- need this line ---
"""


def stable_step(length, n, density, stiffness, part=0.5):
    """A step that is stable with the fourth-order Runge–Kutta scheme: a part of the segment's wave time."""
    return part * length / n / math.sqrt(stiffness / density)


def written(**given):
    """An input file, as MoorDyn wants it."""
    whole = {"diameter": 0.028, "damping": 0.0, "first": "Fixed", "last": "Fixed", "mass": 0, "kb": 1e5, "cb": 0,
             "depth": 1000, "threshold": 1e-3, "most_s": 120, "friction": 0, "scheme": "RK4", **given}
    folder = tempfile.mkdtemp(prefix="moordyn-")
    path = os.path.join(folder, "in.txt")
    text = INPUT.format(**whole)
    # Names of options differ between versions; this one has only the second.
    text = "\n".join(line for line in text.splitlines() if not line.endswith(" FrictionCoefficient"))
    with open(path, "w") as file:
        file.write(text + "\n")
    return path


class Quiet:
    """MoorDyn prints to standard output whatever it is told; the driver reads that."""

    def __enter__(self):
        self.kept = os.dup(1)
        self.none = os.open(os.devnull, os.O_WRONLY)
        os.dup2(self.none, 1)

    def __exit__(self, *_):
        os.dup2(self.kept, 1)
        os.close(self.none)
        os.close(self.kept)


def line_nodes(system, n):
    """Places of the nodes, m."""
    line = moordyn.GetLine(system, 1)
    return np.array([moordyn.GetLineNodePos(line, k) for k in range(n + 1)])[:, [0, 2]]


def at_rest(scene, n, threshold):
    """Both ends fixed; the answer is what it begins its own simulations from."""
    length, stiffness, load = scene.warm
    floor = scene.id == "slack-to-floor"
    low = 0.5 * scene.diameter_m
    (ax, az), (bx, bz) = scene.ends
    dt = stable_step(length, n, scene.density_kg_per_m, stiffness)
    # The seabed pushes by kb for each square metre of cable and each metre of depth.
    path = written(
        density=scene.density_kg_per_m, stiffness=stiffness, damping=-0.5, ax=ax, az=az - low, bx=bx,
        bz=bz - low, length=length, n=n, dt=dt, threshold=threshold, depth=0 if floor else 1000, cb=1e4 if floor else 0,
        kb=1e7 if floor else 1e5,
    )

    def build():
        system = moordyn.Create(path)
        moordyn.SetVerbosity(system, moordyn.LEVEL_NONE)
        return system

    def solve(system):
        moordyn.Init(system, [], [])
        return system

    with Quiet():
        system, cost = least(build, solve, seconds=0.3)
        places = line_nodes(system, n) + [0.0, low]
        line = moordyn.GetLine(system, 1)
        half = -load * 0.5 * length / n
        forces = []
        for k, other in ((0, 1), (n, n - 1)):
            size = np.linalg.norm(np.array(moordyn.GetLineNodeTen(line, k))[[0, 2]] * [1, 1])
            along = (places[other] - places[k]) / np.linalg.norm(places[other] - places[k])
            forces.append(size * along - half)
    arcs = np.linspace(0.0, scene.length_m, n + 1)
    error, shape = scene.errors(forces, max(np.linalg.norm(f) for f in forces), arcs, places)
    setting = f"N={n} threshIC={threshold:.0e}"
    if not math.isfinite(error):
        return Point(setting, note="failed: no finite answer")
    return Point(setting, cost, error, shape, "floor of springs; friction left out" if floor else "")


def placed(path, places):
    """A system that begins at other places: its saved state is changed, as it cannot be told them."""
    system = moordyn.Create(path)
    moordyn.SetVerbosity(system, moordyn.LEVEL_NONE)
    moordyn.Init_NoIC(system, [], [])
    n = len(places) - 1
    was = line_nodes(system, n)
    state = np.frombuffer(moordyn.Serialize(system), dtype=np.float64).copy()
    for k in range(1, n):
        for axis in range(2):
            found = np.flatnonzero(state == was[k, axis])
            state[found] = places[k, axis]
    moordyn.Deserialize(system, state.tobytes())
    if np.abs(line_nodes(system, n) - places).max() > 1e-9:
        raise RuntimeError("the saved state could not be changed")
    return system


def falling(scene_id, n, part):
    """The swing and the fold, from a changed state."""
    places = scenes.folded(n) if scene_id == "fold" else np.column_stack(
        [np.linspace(0.0, 10.0, n + 1), np.zeros(n + 1)])
    dt = stable_step(10.0, n, 1.0, 1e7, part)
    path = written(density=1.0, stiffness=1e7, last="Free", ax=0, az=0, bx=places[-1][0], bz=places[-1][1], length=10.0,
                   n=n, dt=dt)
    every = 1.0 if scene_id == "swing" else 1.0 / 960.0
    end_s = 1.0 if scene_id == "swing" else 1.2

    def build():
        return placed(path, places)

    def solve(system):
        line, seen = moordyn.GetLine(system, 1), []
        for k in range(round(end_s / every)):
            moordyn.Step(system, [], [], k * every, every)
            seen.append(moordyn.GetLineNodePos(line, n))
        return seen

    with Quiet():
        seen, cost = least(build, solve, seconds=0.2)
    tip = np.array(seen)[:, [0, 2]]
    if scene_id == "swing":
        error = np.linalg.norm(tip[-1] - scenes.SWING_TIP_M) / np.linalg.norm(scenes.SWING_TIP_M)
    else:
        times = np.arange(1, len(tip) + 1) * every
        error = abs(scenes.crossing(times, -tip[:, 1], 6.0) / scenes.FOLD_S - 1.0)
    setting = f"N={n} dt={part:g}l/c"
    if not math.isfinite(error):
        return Point(setting, note="failed: no finite answer")
    return Point(setting, cost, float(error), None, "begins from a changed saved state")


def snap(dt):
    """The mass falls 2 m before the rope is taut: a line of one segment, slack until then."""
    path = written(density=1e-6, stiffness=scenes.SNAP_EA_N, last="Free", mass=scenes.SNAP_MASS_KG, ax=0, az=0, bx=0,
                   bz=-8.0, length=10.0, n=1, dt=dt)
    every = dt

    def build():
        system = moordyn.Create(path)
        moordyn.SetVerbosity(system, moordyn.LEVEL_NONE)
        moordyn.Init_NoIC(system, [], [])
        return system

    def solve(system):
        point, seen = moordyn.GetPoint(system, 2), []
        for k in range(round(1.6 / every)):
            moordyn.Step(system, [], [], k * every, every)
            seen.append(moordyn.GetPointPos(point)[2])
        return seen

    with Quiet():
        seen, cost = least(build, solve, seconds=0.2)
    pull = scenes.greatest([scenes.SNAP_EA_N * (-z / 10.0 - 1.0) for z in seen])
    error = abs(pull / scenes.SNAP_PULL_N - 1.0)
    setting = f"N=1 dt=1/{round(1 / dt)}"
    if not math.isfinite(error) or error > 0.999:
        return Point(setting, note="failed: no greatest pull")
    return Point(setting, cost, error, None, "its fall of 2 m before is followed as well")


def drag(n, part):
    """A tail on its seabed behind a coupled point."""
    low = 0.014
    lying = 5.3
    up = math.sqrt(1.3**2 - (0.35 - low) ** 2)
    dt = stable_step(6.6, n, 1.246, 2e6, part)
    path = written(density=1.246, stiffness=2e6, damping=-0.02, first="Free", last="Coupled", ax=6.0 - up - lying, az=0.0,
                   bx=6.0, bz=0.35 - low, length=6.6, n=n, dt=dt, depth=0, kb=1e6, cb=1e3, friction=0.5)
    arcs = np.linspace(0.0, 6.6, n + 1)
    places = np.column_stack([
        np.where(arcs < lying, 6.0 - up - lying + arcs, 6.0 - up + (arcs - lying) / 1.3 * up),
        np.where(arcs < lying, 0.0, (arcs - lying) / 1.3 * (0.35 - low)),
    ])
    every = 1.0 / 240.0

    def build():
        system = moordyn.Create(path)
        moordyn.SetVerbosity(system, moordyn.LEVEL_NONE)
        moordyn.Init_NoIC(system, [6.0, 0.0, 0.35 - low], [0.0, 0.0, 0.0])
        return system

    def solve(system):
        line, pulls = moordyn.GetLine(system, 1), []
        for k in range(round(6.0 / every)):
            t = k * every
            x, v = scenes.hand_of_drag(t)
            moordyn.Step(system, [x, 0.0, 0.35 - low], [v, 0.0, 0.0], t, every)
            if t + every > 4.0:
                f = np.array(moordyn.GetLineNodeTen(line, n))[[0, 2]]
                half = 0.5 * 6.6 / n * 1.246 * scenes.GRAVITY
                pulls.append(math.hypot(f[0], abs(f[1]) + half))
        return np.mean(pulls)

    with Quiet():
        pull, cost = least(build, solve, seconds=0.1)
    error = abs(pull / scenes.DRAG_PULL_N - 1.0)
    setting = f"N={n} dt={part:g}l/c"
    if not math.isfinite(error):
        return Point(setting, note="failed: no finite answer")
    return Point(setting, cost, float(error), None, "floor of springs")


def points(scene_id):
    """All points of a scene."""
    if scene_id in ("hanging-span", "near-taut", "steep-span", "slack-to-floor"):
        for n in [5, 10, 20, 40, 80]:
            for threshold in (1e-1, 1e-3, 1e-5):
                yield at_rest(rest(scene_id), n, threshold)
    elif scene_id in ("swing", "fold"):
        for n in [10, 20, 40, 80] if scene_id == "swing" else [11, 21, 41, 81]:
            for part in (0.5, 0.25):
                yield falling(scene_id, n, part)
    elif scene_id == "snap":
        for dt in (1 / 240, 1 / 960, 1 / 3840):
            yield snap(dt)
    elif scene_id == "drag":
        for n in (30, 60):
            yield drag(n, 0.5)
    elif scene_id == "loads-wind-heat":
        yield cannot("not tried: wind is a drag of moving air, no load")
    elif scene_id in IN_MOTION:
        yield cannot("not tried")
    else:
        yield cannot("no obstacles but a seabed, no pulleys")
