"""Exudyn: plane cables of the absolute nodal coordinate formulation (ANCF), Newton, generalized alpha."""

import math

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    CoordinateConstraint, LoadMassProportional, LoadCoordinate, MarkerBodyCable2DShape, MarkerBodyMass,
    MarkerBodyRigid, MarkerNodeCoordinate, MarkerNodePosition, MassPoint2D, NodeGenericData, NodePoint2D,
    NodePoint2DSlope1, NodePointGround, ObjectANCFCable2D, ObjectContactFrictionCircleCable2D, ObjectGround,
    SensorNode, SensorObject,
)

import scenes
from guess import guess, sagging
from measure import Point, cannot, least
from scenes import IN_MOTION, rest

MESHES = [2, 4, 8, 16, 32, 64, 128]
# A circle as wide as this is a floor: over 10 m it falls by 12 µm.
FLOOR_RADIUS_M = 1e6


class Cable:
    """A cable of ANCF elements in a system of its own, its ends held."""

    def __init__(self, places, slopes, parts_m, stiffness_n, density, pull_n_per_kg, held, bending=0.0,
                 moves=None, speeds=None, kinks=None):
        container = exu.SystemContainer()
        self.container, self.mbs = container, container.AddSystem()
        mbs = self.mbs
        self.ground = mbs.AddNode(NodePointGround())
        ground = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=self.ground, coordinate=0))
        self.nodes = []
        for k, (x, t) in enumerate(zip(places, slopes)):
            speed = [0.0] * 4 if speeds is None else list(speeds[k])
            node = NodePoint2DSlope1(referenceCoordinates=[*x, *t], initialVelocities=speed)
            self.nodes.append(mbs.AddNode(node))
        # At a kink two nodes share a place and each has its slope: here that of what follows.
        twins = {}
        for k in kinks or {}:
            twins[k] = mbs.AddNode(NodePoint2DSlope1(referenceCoordinates=[*places[k], *kinks[k]]))
            for axis in range(2):
                pair = [mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=number, coordinate=axis))
                        for number in (self.nodes[k], twins[k])]
                mbs.AddObject(CoordinateConstraint(markerNumbers=pair))
        self.elements = []
        for k, part in enumerate(parts_m):
            body = mbs.AddObject(ObjectANCFCable2D(
                physicsLength=part, physicsMassPerLength=density, physicsBendingStiffness=bending,
                physicsAxialStiffness=stiffness_n,
                nodeNumbers=[twins.get(k, self.nodes[k]), self.nodes[k + 1]],
            ))
            self.elements.append(body)
            mass = mbs.AddMarker(MarkerBodyMass(bodyNumber=body))
            mbs.AddLoad(LoadMassProportional(markerNumber=mass, loadVector=[*pull_n_per_kg, 0.0]))
        self.constraints = []
        for k in held:
            pair = []
            for axis in range(2):
                marker = MarkerNodeCoordinate(nodeNumber=self.nodes[k], coordinate=axis)
                more = {}
                if moves and (k, axis) in moves:
                    more = {"offsetUserFunction": moves[k, axis][0], "offsetUserFunction_t": moves[k, axis][1]}
                pair.append(mbs.AddObject(CoordinateConstraint(
                    markerNumbers=[ground, mbs.AddMarker(marker)], **more)))
            self.constraints.append(pair)

    def push(self, node, force_n):
        """A force on a node."""
        for axis in range(2):
            marker = MarkerNodeCoordinate(nodeNumber=self.nodes[node], coordinate=axis)
            number = self.mbs.AddMarker(marker)
            self.mbs.AddLoad(LoadCoordinate(markerNumber=number, load=float(force_n[axis])))

    def touch(self, center, radius, segments, stiffness, friction=0.0, penalty=0.0, stick=0.0, damping=0.0):
        """Contact of every element with a circle."""
        mbs = self.mbs
        base = mbs.AddObject(ObjectGround(referencePosition=[*center, 0.0]))
        marker = mbs.AddMarker(MarkerBodyRigid(bodyNumber=base))
        for body in self.elements:
            shape = mbs.AddMarker(MarkerBodyCable2DShape(bodyNumber=body, numberOfSegments=segments))
            begin = [0.1] * segments + [-2.0] * segments + [0.0] * segments
            data = mbs.AddNode(NodeGenericData(initialCoordinates=begin, numberOfDataCoordinates=3 * segments))
            mbs.AddObject(ObjectContactFrictionCircleCable2D(
                markerNumbers=[marker, shape], nodeNumber=data, numberOfContactSegments=segments,
                contactStiffness=stiffness, contactDamping=damping, frictionVelocityPenalty=penalty,
                frictionStiffness=stick, frictionCoefficient=friction, circleRadius=radius,
            ))

    def assemble(self):
        """Ready to be solved."""
        self.mbs.Assemble()
        return self

    def settings(self, end_s=1.0, dt=None, spectral=0.9):
        """Settings with all output off."""
        s = exu.SimulationSettings()
        s.solutionSettings.writeSolutionToFile = False
        s.displayComputationTime = False
        s.parallel.numberOfThreads = 1
        s.linearSolverType = exu.LinearSolverType.EigenSparse
        for part in (s.staticSolver, s.timeIntegration):
            part.verboseMode = 0
        s.staticSolver.newton.maxIterations = 100
        s.staticSolver.discontinuous.maxIterations = 50
        if dt:
            s.timeIntegration.endTime = end_s
            s.timeIntegration.numberOfSteps = round(end_s / dt)
            s.timeIntegration.generalizedAlpha.spectralRadius = spectral
            s.timeIntegration.newton.useModifiedNewton = True
        return s

    def places(self):
        """Where its nodes are, m."""
        at = [self.mbs.GetNodeOutput(n, exu.OutputVariableType.Position)[:2] for n in self.nodes]
        return np.array(at)

    def forces(self, load):
        """Forces of the cable on its supports."""
        force = exu.OutputVariableType.Force
        got = [[float(self.mbs.GetObjectOutput(c, force)) for c in pair] for pair in self.constraints]
        return np.array(got)


# The one corner of the beam that is touched, m.
BEAM_M = np.array([4.3, 2.5])


def along(corners, arcs):
    """Places and slopes along a polyline, drawn to fit it."""
    corners = np.array(corners)
    steps = np.diff(corners, axis=0)
    long = np.linalg.norm(steps, axis=1)
    at = np.concatenate([[0.0], np.cumsum(long)])
    fit = at[-1] / arcs[-1]
    places = np.column_stack([np.interp(arcs * fit, at, corners[:, i]) for i in range(2)])
    k = np.clip(np.searchsorted(at, arcs * fit, side="right") - 1, 0, len(long) - 1)
    return places, steps[k] / long[k][:, None] * fit


def parabola(scene, arcs, floor_m=None):
    """Places and slopes of a parabola (or a given row of points) a little longer than the cable."""
    fine = guess(scene, 4000, floor_m)
    s = np.linspace(0.0, arcs[-1], 4001)
    at = np.column_stack([np.interp(arcs, s, fine[:, i]) for i in range(2)])
    slope = np.gradient(fine, s, axis=0)
    slope /= np.linalg.norm(slope, axis=1)[:, None]
    return at, np.column_stack([np.interp(arcs, s, slope[:, i]) for i in range(2)]) * (1.0 + 1e-4)


def at_rest(scene, n, steps=1):
    """A scene at rest by its static solver."""
    length, stiffness, load = scene.warm
    a = 1.0 + scene.heat_strain
    arcs = np.linspace(0.0, length, n + 1)
    for s, _ in scene.loads:
        arcs[np.argmin(abs(arcs - s * a))] = s * a
    loaded = [int(np.argmin(abs(arcs - s * a))) for s, _ in scene.loads]
    radius = 0.5 * scene.diameter_m
    floor = radius if scene.id == "slack-to-floor" else None
    places, slopes = parabola(scene, arcs, floor)
    if scene.id == "over-beam":
        # Two parabolas that meet over the corner, both as much longer than their chords.
        corner = BEAM_M + [0.6 * radius, 0.8 * radius]
        chords = [np.linalg.norm(corner - end) for end in scene.ends]
        parts = [length * c / sum(chords) for c in chords]
        down = np.array([0.0, -1.0])
        first = sagging(scene.ends[0], corner, parts[0], down, 2000)
        places, slopes = along([*first, *sagging(corner, scene.ends[1], parts[1], down, 2000)[1:]], arcs)
    density = scene.density_kg_per_m
    setting = f"ANCF N={n}"
    note = ""
    if scene.id == "slack-to-floor":
        note = "floor: a circle of 1e6 m; friction left out"

    if scene.id == "over-beam":
        note = "beam: a circle at its one corner that is touched; friction left out, none acts"

    def build():
        cable = Cable(places, slopes, np.diff(arcs), stiffness, density, load / density, [0, n],
                      kinks={k: slopes[k] for k in loaded})
        for s, force in scene.loads:
            cable.push(int(np.argmin(abs(arcs - s * a))), force)
        if scene.id == "slack-to-floor":
            cable.touch([4.0, -FLOOR_RADIUS_M], FLOOR_RADIUS_M + floor, 4, 1e5)
        if scene.id == "over-beam":
            cable.touch(BEAM_M, radius, 4, 1e6)
        return cable.assemble()

    def solve(cable):
        settings = cable.settings()
        settings.staticSolver.numberOfLoadSteps = steps
        cable.mbs.SolveStatic(settings)
        return cable

    try:
        cable, cost = least(build, solve)
    except Exception as error:
        return Point(setting, note=f"failed: {type(error).__name__} in the static solver")
    forces = cable.forces(load)
    if forces.sum(0) @ load < 0:
        forces = -forces
    greatest = max(np.linalg.norm(forces, axis=1))
    error, shape = scene.errors(forces, greatest, arcs / a, cable.places())
    return Point(setting, cost, error, shape, note)


def chain(scene_id, n, dt, spectral):
    """The swing, the fold or the snap."""
    setting = f"ANCF N={n} dt=1/{round(1 / dt)} rho={spectral}"
    even = np.linspace(0.0, 10.0, n + 1)
    speeds, density, stiffness, kinks = None, 1.0, 1e7, None
    if scene_id == "swing":
        places, slopes = np.column_stack([even, 0 * even]), np.tile([1.0, 0.0], (n + 1, 1))
    elif scene_id == "fold":
        places = scenes.folded(n)
        links = np.diff(places, axis=0) * n / 10.0
        slopes = np.vstack([links[:1], links])
        kinks = {k: links[k] for k in ((n - 1) // 2, (n - 1) // 2 + 1)}
    else:
        places, slopes = np.column_stack([0 * even, -even]), np.tile([0.0, -1.0], (n + 1, 1))
        v = -scenes.SNAP_SPEED / 10.0
        speeds = np.column_stack([0 * even, v * even, 0 * even, v + 0 * even])
        density, stiffness = 1e-6, scenes.SNAP_EA_N

    def build():
        cable = Cable(places, slopes, np.full(n, 10.0 / n), stiffness, density, [0.0, -scenes.GRAVITY], [0],
                      speeds=speeds, kinks=kinks)
        if scene_id == "snap":
            mass = scenes.SNAP_MASS_KG
            point = cable.mbs.AddNode(NodePoint2D(referenceCoordinates=[0.0, -10.0],
                                                  initialVelocities=[0.0, -scenes.SNAP_SPEED]))
            cable.mbs.AddObject(MassPoint2D(physicsMass=mass, nodeNumber=point))
            for axis in range(2):
                pair = [cable.mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=number, coordinate=axis))
                        for number in (cable.nodes[n], point)]
                cable.mbs.AddObject(CoordinateConstraint(markerNumbers=pair))
            cable.push(n, [0.0, -mass * scenes.GRAVITY])
        cable.sensor = cable.mbs.AddSensor(SensorNode(
            nodeNumber=cable.nodes[n], outputVariableType=exu.OutputVariableType.Position, storeInternal=True))
        return cable.assemble()

    def solve(cable):
        settings = cable.settings(1.2 if scene_id == "fold" else 1.0, dt, spectral)
        settings.solutionSettings.sensorsWritePeriod = dt
        cable.mbs.SolveDynamic(settings)
        return cable

    try:
        cable, cost = least(build, solve, seconds=0.3)
    except Exception as error:
        return Point(setting, note=f"failed: {type(error).__name__} in the dynamic solver")
    seen = cable.mbs.GetSensorStoredData(cable.sensor)
    if scene_id == "swing":
        error = np.linalg.norm(seen[-1, 1:3] - scenes.SWING_TIP_M) / np.linalg.norm(scenes.SWING_TIP_M)
    elif scene_id == "fold":
        error = abs(scenes.crossing(seen[:, 0], -seen[:, 2], 6.0) / scenes.FOLD_S - 1.0)
    else:
        pull = scenes.greatest(list(scenes.SNAP_EA_N * (-seen[:, 2] / 10.0 - 1.0)))
        error = abs(pull / scenes.SNAP_PULL_N - 1.0)
    return Point(setting, cost, float(error), None, "" if math.isfinite(error) else "failed: no figure")


def hauled(scene_id, n, dt):
    """The capstan and the drag: a hand draws, the mean of its pull is wanted."""
    setting = f"ANCF N={n} dt=1/{round(1 / dt)} rho=0.3"
    if scene_id == "drag":
        length, density, stiffness, friction = 6.6, 1.246, 2e6, 0.5
        hand, axis, end_s, from_s = [6.0, 0.35], 0, 6.0, 4.0
        lying = 5.3
        up = math.sqrt((length - lying) ** 2 - (0.35 - 0.014) ** 2)
        corners = [[6.0 - up - lying, 0.014], [6.0 - up, 0.014], hand]
        center, radius, exact = [3.0, -FLOOR_RADIUS_M], FLOOR_RADIUS_M + 0.014, scenes.DRAG_PULL_N
        law = lambda t: tuple(np.array(scenes.hand_of_drag(t)) - [6.0, 0.0])
        gravity, note = -scenes.GRAVITY, "bending of 1e-3 N m²; friction of a slip speed, 1e3 N s/m"
        contact = {"stiffness": 1e5, "penalty": 1e3, "damping": 1e2, "segments": 4}
    else:
        length, density, stiffness, friction = 0.6 + 0.101 * math.pi, 0.05, 1e4, scenes.RUBS
        round_ = [[-0.101 * math.cos(b), 0.101 * math.sin(b)] for b in np.linspace(0, math.pi, 400)]
        hand, axis, end_s, from_s = [0.101, -0.3], 1, 1.5, 0.75
        corners = [[-0.101, -0.3], *round_, hand]
        center, radius, exact = [0.0, 0.0], 0.101, scenes.CAPSTAN_RATIO * scenes.HUNG_N
        law = lambda t: tuple(-x for x in scenes.hand_of_capstan(t))
        # A cord of no mass and no bending fails in its second step.
        gravity, note = 0.0, "0.05 kg/m without weight, bending of 1e-3 N m²; friction of a slip speed, 1e2 N s/m"
        contact = {"stiffness": 1e5, "penalty": 1e2, "damping": 10.0, "segments": 4}
    arcs = np.linspace(0.0, length, n + 1)
    places, slopes = along(corners, arcs)

    def build():
        moves = {(n, axis): (lambda mbs, t, i, offset: law(t)[0], lambda mbs, t, i, offset: law(t)[1])}
        cable = Cable(places, slopes, np.diff(arcs), stiffness, density, [0.0, gravity], [n], moves=moves,
                      bending=1e-3)
        if scene_id == "capstan-half":
            cable.push(0, [0.0, -scenes.HUNG_N])
        cable.touch(center, radius, friction=friction, **contact)
        cable.sensors = [cable.mbs.AddSensor(SensorObject(
            objectNumber=c, outputVariableType=exu.OutputVariableType.Force, storeInternal=True))
            for c in cable.constraints[0]]
        return cable.assemble()

    def solve(cable):
        settings = cable.settings(end_s, dt, 0.3)
        settings.solutionSettings.sensorsWritePeriod = dt
        settings.timeIntegration.newton.useModifiedNewton = False
        settings.timeIntegration.newton.relativeTolerance = 1e-5
        settings.timeIntegration.discontinuous.iterationTolerance = 1.0
        settings.timeIntegration.discontinuous.maxIterations = 3
        settings.timeIntegration.discontinuous.ignoreMaxIterations = True
        cable.mbs.SolveDynamic(settings)
        return cable

    try:
        cable, cost = least(build, solve, seconds=0.1)
    except Exception as error:
        return Point(setting, note=f"failed: {type(error).__name__} in the dynamic solver")
    both = [cable.mbs.GetSensorStoredData(s) for s in cable.sensors]
    pulls = np.hypot(both[0][:, 1], both[1][:, 1])[both[0][:, 0] > from_s]
    error = abs(pulls.mean() / exact - 1.0)
    return Point(setting, cost, float(error), None, note)


def points(scene_id):
    """All points of a scene."""
    if scene_id in ("hanging-span", "near-taut", "steep-span", "slack-to-floor"):
        for n in MESHES:
            yield at_rest(rest(scene_id), n)
    elif scene_id == "over-beam":
        for n in [27, 54, 108, 216]:
            yield at_rest(rest(scene_id), n)
    elif scene_id == "loads-wind-heat":
        for n in [8, 16, 32, 64, 128]:
            yield at_rest(rest(scene_id), n)
    elif scene_id in ("swing", "fold", "snap"):
        # Finer swings and folds take seconds, as steps are halved where Newton fails.
        meshes = {"swing": [5, 10, 20, 40], "fold": [11, 21, 41], "snap": [1, 4]}[scene_id]
        for n in meshes:
            for dt in [1 / 240, 1 / 960, 1 / 3840]:
                yield chain(scene_id, n, dt, 0.9)
    elif scene_id in ("drag", "capstan-half"):
        for n, dt in [(30, 1 / 960), (30, 1 / 3840), (60, 1 / 3840)]:
            yield hauled(scene_id, n, dt)
    elif scene_id == "round-post":
        yield cannot("friction at rest that depends on the laying")
    elif scene_id == "pulley-waypoints":
        yield cannot("its reeving system has no weight and no friction at a wheel")
    elif scene_id in IN_MOTION:
        yield cannot("not tried")
