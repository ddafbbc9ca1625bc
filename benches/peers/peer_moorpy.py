"""MoorPy: quasi-static, the catenary in closed form for a line, Newton on the points between."""

import numpy as np
from moorpy import System
from moorpy.Catenary import catenary

from measure import Point, cannot, least
from scenes import AT_REST, IN_MOTION, rest

# How deep the seabed lies, m: what stands above 0 m would be out of the water.
DEPTH = 100.0
SPANS = ["hanging-span", "near-taut", "steep-span"]


def turned(scene):
    """The frame in which the load points down: its axes as rows, and the load's size."""
    _, _, load = scene.warm
    size = np.linalg.norm(load)
    up = -load / size
    return np.array([[up[1], -up[0]], up]), size


def span(scene, tolerance):
    """The function `catenary` alone, as MoorPy calls it for each of its lines."""
    length, stiffness, _ = scene.warm
    axes, weight = turned(scene)
    along, up = axes @ (scene.ends[1] - scene.ends[0])

    def solve(plots):
        given = {"CB": -1e3, "Tol": tolerance, "nNodes": 41, "plots": plots}
        return catenary(along, up, length, stiffness, weight, **given)

    (ax, az, bx, bz, _), cost = least(lambda: 0, solve)
    forces = flipped(scene, np.array([[ax, az], [bx, bz]]) @ axes)
    info = solve(1)[4]
    places = scene.ends[0] + np.column_stack([info["X"], info["Z"]]) @ axes
    tension = max(np.linalg.norm(f) for f in forces)
    arcs = info["s"] / (1.0 + scene.heat_strain)
    error, shape = scene.errors(forces, tension, arcs, places)
    yield Point(f"catenary Tol={tolerance:.0e}", cost, error, shape, "its function for one line")


def flipped(scene, forces):
    """Forces on the supports: their sum is the load, whatever sign MoorPy gives them."""
    total = scene.load_n_per_m * scene.length_m
    return forces if forces.sum(0) @ total > 0 else -forces


def system(scene, places, lengths, depth, friction, tolerance, forces=()):
    """A system of lines between points; those of `forces` are free and carry them."""
    _, stiffness, _ = scene.warm
    _, weight = turned(scene)
    ms = System(depth=depth, rho=0.0, g=1.0)
    # `setLineType` of this version cannot be given numbers alone: the dictionary is as it makes it.
    kind = {"name": "cable", "d_vol": scene.diameter_m, "w": weight, "m": weight, "EA": stiffness}
    ms.lineTypes["cable"] = {**kind, "material": "", "d_nom": 0.0, "notes": ""}
    free = dict(forces)
    for k, place in enumerate(places):
        r = np.array([place[0], 0.0, place[1]])
        kind = 0 if k in free else 1
        load = np.array([free[k][0], 0.0, free[k][1]]) if k in free else np.zeros(3)
        ms.addPoint(kind, r, fExt=load)
    for k, length in enumerate(lengths):
        ms.addLine(length, "cable", pointA=k + 1, pointB=k + 2)
    for line in ms.lineList:
        line.cb = friction
        line.nNodes = 41
    ms.initialize()
    return ms


def loads(tolerance):
    """Three lines between two free points that carry the loads, in the frame of the load."""
    scene = rest("loads-wind-heat")
    axes, _ = turned(scene)
    a = 1.0 + scene.heat_strain
    arcs = [0.0, *[s for s, _ in scene.loads], scene.length_m]
    start, end = scene.ends
    places = [start + (end - start) * s / scene.length_m - [0, 3.0 * (0 < s < 16)] for s in arcs]
    places = [axes @ p for p in places]
    forces = [(k + 1, axes @ f) for k, (_, f) in enumerate(scene.loads)]

    def build():
        return system(scene, places, np.diff(arcs) * a, 1e4, 0.0, tolerance, forces)

    def solve(ms):
        ms.solveEquilibrium(tol=tolerance)
        return ms

    ms, cost = least(build, solve)
    yield answer(scene, ms, arcs, axes, cost, f"System tol={tolerance:.0e}", "frame turned to the load")


def answer(scene, ms, arcs, axes, cost, setting, note):
    """What a system says, held against the reference."""
    first, last = ms.lineList[0], ms.lineList[-1]
    forces = np.array([first.fA[[0, 2]], last.fB[[0, 2]]]) @ axes
    tension = max(max(line.TA, line.TB) for line in ms.lineList)
    at, places = [], []
    for line, begin, end in zip(ms.lineList, arcs, arcs[1:]):
        x, _, z, _ = line.getLineCoords(0.0, n=41)
        at.append(np.linspace(begin, end, 41))
        places.append(np.column_stack([x, z]) @ axes)
    error, shape = scene.errors(flipped(scene, forces), tension, np.concatenate(at), np.vstack(places))
    return Point(setting, cost, error, shape, note)


def floor(tolerance):
    """The floor one radius up, without friction: nothing slides that would need it."""
    scene = rest("slack-to-floor")
    up = 0.5 * scene.diameter_m
    (left, height), (right, _) = scene.ends
    length, stiffness, load = scene.warm

    def one(plots):
        given = {"CB": up - height, "Tol": tolerance, "nNodes": 41, "plots": plots}
        return catenary(right - left, 0.0, length, stiffness, -load[1], **given)

    (ax, az, bx, bz, _), cost = least(lambda: 0, one)
    forces = flipped(scene, np.array([[ax, az], [bx, bz]]))
    info = one(1)[4]
    places = scene.ends[0] + np.column_stack([info["X"], info["Z"]])
    pulls = np.linalg.norm(forces, axis=1)
    error, shape = scene.errors(forces, pulls.max(), info["s"], places)
    note = "its function for one line; friction left out"
    yield Point(f"catenary Tol={tolerance:.0e}", cost, error, shape, note)

    def solve(ms):
        ms.solveEquilibrium(tol=tolerance)
        return ms

    # The same as two lines that meet in a free point on the floor, as moorings are often drawn.
    half = 0.5 * length
    lower = [0.0, DEPTH + up]
    joint = [scene.ends[0] - lower, np.array([4.0, -DEPTH]), scene.ends[1] - lower]
    ms, cost = least(
        lambda: system(scene, joint, [half, half], DEPTH, 0.0, tolerance, [(1, np.zeros(2))]), solve
    )
    # Their places are those of the lowered frame.
    point = answer(scene, ms, [0.0, half, 2 * half], np.eye(2), cost, f"two lines tol={tolerance:.0e}",
                   "friction left out; shape not compared")
    point.shape_error = None
    yield point


def points(scene_id):
    """All points of a scene."""
    tolerances = [1e-2, 1e-4, 1e-6, 1e-9, 1e-12]
    if scene_id in SPANS:
        for tolerance in tolerances:
            yield from span(rest(scene_id), tolerance)
    elif scene_id == "loads-wind-heat":
        for tolerance in [1e-1, 1e-2, 1e-4, 1e-6, 1e-9]:
            yield from loads(tolerance)
    elif scene_id == "slack-to-floor":
        for tolerance in tolerances:
            yield from floor(tolerance)
    elif scene_id in AT_REST:
        yield cannot("no obstacles but a seabed, no pulleys")
    elif scene_id in IN_MOTION:
        yield cannot("quasi-static: no motion with inertia")
