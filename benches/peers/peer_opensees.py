"""OpenSees (openseespy): corotational trusses or its CatenaryCable, Newton at rest, TRBDF2 or HHT in motion."""

import math

import numpy as np
import openseespy.opensees as ops

import scenes
from guess import guess
from measure import Point, cannot, least
from scenes import AT_REST, IN_MOTION, rest

MESHES = [5, 10, 20, 40, 80, 160, 320]


def truss(k, i, j, natural_m, stiffness_n, density, places):
    """A corotational truss whose natural length is not that of the guess: by an initial strain."""
    drawn = np.linalg.norm(places[j] - places[i])
    modulus = stiffness_n * drawn / natural_m
    ops.uniaxialMaterial("Elastic", 2 * k, modulus)
    ops.uniaxialMaterial("InitStrainMaterial", 2 * k + 1, 2 * k, (drawn - natural_m) / drawn)
    extra = ["-rho", density, "-cMass", 1] if density else []
    ops.element("corotTruss", k + 1, i + 1, j + 1, 1.0, 2 * k + 1, *extra)


def forces_at(nodes):
    """Forces of the cable on its supports."""
    ops.reactions()
    return [-np.array(ops.nodeReaction(k)) for k in nodes]


def analysis(kind, tolerance=1e-9):
    """The usual choices of a static analysis: band matrix, Newton, all load in one step."""
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", tolerance, 200, 0)
    ops.algorithm(*kind)
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")


def trusses(scene, n, floor=False):
    """A span of trusses with the load on its nodes."""
    length, stiffness, load = scene.warm
    arcs = np.linspace(0.0, length, n + 1)
    a = 1.0 + scene.heat_strain
    # Point loads want nodes of their own.
    for s, _ in scene.loads:
        arcs[np.argmin(abs(arcs - s * a))] = s * a
    even = guess(scene, 2000, 0.5 * scene.diameter_m if floor else None)
    places = np.column_stack(
        [np.interp(arcs, np.linspace(0.0, length, 2001), even[:, i]) for i in range(2)]
    )

    def build():
        ops.wipe()
        ops.model("basic", "-ndm", 2, "-ndf", 2)
        for k, place in enumerate(places):
            ops.node(k + 1, *map(float, place))
        for k in (1, n + 1):
            ops.fix(k, 1, 1)
        for k in range(n):
            truss(k, k, k + 1, arcs[k + 1] - arcs[k], stiffness, 0.0, places)
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        part = np.zeros(n + 1)
        part[:-1] += 0.5 * np.diff(arcs)
        part[1:] += 0.5 * np.diff(arcs)
        for k in range(n + 1):
            force = load * part[k]
            for s, point in scene.loads:
                force = force + point * (abs(arcs[k] - s * a) < 1e-12)
            ops.load(k + 1, *map(float, force))
        if floor:
            lay(scene, places, part)
        analysis(("NewtonLineSearch", "-type", "Bisection") if not floor else FLOOR_NEWTON)

    def solve(_):
        return ops.analyze(1)

    code, cost = least(build, solve)
    if code != 0:
        return Point(f"trusses N={n}", note="failed: Newton did not converge")
    forces = forces_at([1, n + 1])
    pulls = [ops.eleResponse(k + 1, "axialForce")[0] for k in range(n)]
    now = places + [ops.nodeDisp(k + 1) for k in range(n + 1)]
    greatest = max([*pulls, *(np.linalg.norm(f) for f in forces)])
    error, shape = scene.errors(forces, greatest, arcs / a, now)
    note = "floor of springs, 1e6 N/m²; friction left out" if floor else ""
    return Point(f"trusses N={n}", cost, error, shape, note)


# Where contacts open and close, plain Newton and its other searches fail or end far off (N = 40).
FLOOR_NEWTON = ("NewtonLineSearch", "-type", "InitialInterpolated")
# Stiffness of the floor under a metre of cable, N/m².
FLOOR_N_PER_M2 = 1e6


def lay(scene, places, part):
    """The floor: under each node a spring that only pushes and stands still sideways."""
    n = len(places)
    for k in range(1, n - 1):
        above = max(0.0, float(places[k][1] - 0.5 * scene.diameter_m))
        stiffness = float(FLOOR_N_PER_M2 * part[k])
        ops.uniaxialMaterial("ElasticPPGap", 10 * n + k, stiffness, -1e12, -above)
        ops.node(2 * n + k, *map(float, places[k]))
        ops.fix(2 * n + k, 1, 1)
        ops.element("zeroLength", 3 * n + k, 2 * n + k, k + 1, "-mat", 10 * n + k, "-dir", 2)


def cables(scene, n):
    """Its own cable element, an elastic catenary each, in three dimensions."""
    length, stiffness, load = scene.warm
    places = guess(scene, n)
    arcs = np.linspace(0.0, length, n + 1)
    a = 1.0 + scene.heat_strain
    for s, _ in scene.loads:
        arcs[np.argmin(abs(arcs - s * a))] = s * a

    def build():
        ops.wipe()
        ops.model("basic", "-ndm", 3, "-ndf", 3)
        for k, (x, y) in enumerate(places):
            ops.node(k + 1, float(x), 0.0, float(y))
        for k in (1, n + 1):
            ops.fix(k, 1, 1, 1)
        for k in range(n):
            # Its load is that of `eleLoad` alone: its own weight is read and not used.
            given = [1.0, stiffness, 1.0, float(arcs[k + 1] - arcs[k]), 0.0, 0.0, 0.0, 1e-10, 100, 0]
            ops.element("CatenaryCable", k + 1, k + 1, k + 2, *given)
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        ops.eleLoad("-ele", *range(1, n + 1), "-type", "-beamUniform", *map(float, [load[0], 0.0, load[1]]))
        for s, force in scene.loads:
            ops.load(int(np.argmin(abs(arcs - s * a))) + 1, *map(float, [force[0], 0.0, force[1]]))
        analysis(("NewtonLineSearch", "-type", "Bisection"))

    code, cost = least(build, lambda _: ops.analyze(1))
    if code != 0:
        return Point(f"CatenaryCable N={n}", note="failed: Newton did not converge")
    forces = [f[[0, 2]] for f in forces_at([1, n + 1])]
    now = places + [np.array(ops.nodeDisp(k + 1))[[0, 2]] for k in range(n + 1)]
    error, shape = scene.errors(forces, max(np.linalg.norm(f) for f in forces), arcs / a, now)
    return Point(f"CatenaryCable N={n}", cost, error, shape, "")


def moving(n, places, length, density, stiffness, held, scheme, dt, mass_at_end=0.0):
    """A chain of trusses in motion, not drawn, held at some nodes."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 2)
    for k, place in enumerate(places):
        ops.node(k + 1, *map(float, place))
    for k in held:
        ops.fix(k + 1, 1, 1)
    for k in range(n):
        truss(k, k, k + 1, length / n, stiffness, density, places)
    # Accelerations at the start are the user's to give: with none, each scheme is of first order.
    for k in range(1, n + 1):
        ops.setNodeAccel(k + 1, 2, -scenes.GRAVITY, "-commit")
    if mass_at_end:
        ops.mass(n + 1, mass_at_end, mass_at_end)
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    share = np.full(n + 1, length / n * density)
    share[[0, -1]] *= 0.5
    share[-1] += mass_at_end
    for k in range(n + 1):
        ops.load(k + 1, 0.0, float(-share[k] * scenes.GRAVITY))
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", 1e-9, 100, 0)
    ops.algorithm("Newton")
    ops.integrator(*scheme)
    ops.analysis("Transient")


SCHEMES = {"TRBDF2": ("TRBDF2",), "HHT": ("HHT", 0.9), "Newmark": ("Newmark", 0.5, 0.25)}


def follow(end_s, dt, look=None):
    """Steps to the end; None where one fails."""
    seen = []
    for _ in range(round(end_s / dt)):
        if ops.analyze(1, dt) != 0:
            return None
        if look:
            seen.append(look())
    return seen if look else True


def chain(scene_id, n, dt, name):
    """The swing or the fold."""
    if scene_id == "swing":
        places = np.column_stack([np.linspace(0.0, 10.0, n + 1), np.zeros(n + 1)])
    else:
        places = scenes.folded(n)
    setting = f"{name} N={n} dt=1/{round(1 / dt)}"

    def build():
        moving(n, places, 10.0, 1.0, 1e7, [0], SCHEMES[name], dt)

    def solve(_):
        if scene_id == "swing":
            return follow(1.0, dt) and places[-1] + np.array(ops.nodeDisp(n + 1))
        return follow(1.2, dt, lambda: -(places[-1][1] + ops.nodeDisp(n + 1, 2)))

    answer, cost = least(build, solve, seconds=0.3)
    if answer is None:
        return Point(setting, note="failed: Newton did not converge")
    if scene_id == "swing":
        error = np.linalg.norm(answer - scenes.SWING_TIP_M) / np.linalg.norm(scenes.SWING_TIP_M)
    else:
        found = scenes.crossing(np.arange(1, len(answer) + 1) * dt, answer, 6.0)
        error = abs(found / scenes.FOLD_S - 1.0)
    return Point(setting, cost, float(error), None, "" if math.isfinite(error) else "failed")


def snap(n, dt, name):
    """A mass on a rope of no weight, each node at its speed."""
    places = np.column_stack([np.zeros(n + 1), -np.linspace(0.0, 10.0, n + 1)])
    setting = f"{name} N={n} dt=1/{round(1 / dt)}"

    def build():
        moving(n, places, 10.0, 1e-6, scenes.SNAP_EA_N, [0], SCHEMES[name], dt, scenes.SNAP_MASS_KG)
        for k in range(1, n + 1):
            ops.setNodeVel(k + 1, 2, -scenes.SNAP_SPEED * k / n, "-commit")

    def solve(_):
        return follow(1.0, dt, lambda: -ops.nodeDisp(n + 1, 2))

    answer, cost = least(build, solve, seconds=0.3)
    if answer is None:
        return Point(setting, note="failed: Newton did not converge")
    pull = scenes.greatest([scenes.SNAP_EA_N * d / 10.0 for d in answer])
    return Point(setting, cost, abs(pull / scenes.SNAP_PULL_N - 1.0), None, "")


def points(scene_id):
    """All points of a scene."""
    if scene_id in ("hanging-span", "near-taut", "steep-span"):
        scene = rest(scene_id)
        for n in MESHES:
            yield trusses(scene, n)
        for n in [2, 4, 8, 16]:
            yield cables(scene, n)
    elif scene_id == "loads-wind-heat":
        for n in [32, 64, 128, 256, 512]:
            yield trusses(rest(scene_id), n)
        for n in [4, 8]:
            yield cables(rest(scene_id), n)
    elif scene_id == "slack-to-floor":
        for n in MESHES[1:]:
            yield trusses(rest(scene_id), n, floor=True)
    elif scene_id in AT_REST:
        yield cannot("no contact of trusses with bodies and no pulleys")
    elif scene_id in ("swing", "fold"):
        for name in SCHEMES:
            for dt in [1 / 240, 1 / 960, 1 / 3840]:
                for n in [10, 20, 40, 80] if scene_id == "swing" else [11, 21, 41, 81]:
                    yield chain(scene_id, n, dt, name)
    elif scene_id == "snap":
        for name in SCHEMES:
            for dt in [1 / 240, 1 / 960, 1 / 3840]:
                for n in [1, 4]:
                    yield snap(n, dt, name)
    elif scene_id in IN_MOTION:
        yield cannot("not tried" if scene_id == "free-fall" else "no contact of trusses with bodies")
