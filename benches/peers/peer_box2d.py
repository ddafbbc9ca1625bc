"""Box2D v3 (pyb2d3): point masses on distance joints, soft steps; single precision throughout."""

import math

import numpy as np
import pyb2d3 as b2d

import scenes
from guess import guess
from measure import Point, cannot, least
from scenes import IN_MOTION, rest


def world(gravity):
    """A world without sleep."""
    made = b2d.World(gravity=tuple(map(float, gravity)))
    made.sleeping_enabled = False
    return made


def mass_at(made, place, mass, speed=(0.0, 0.0), damping=0.0):
    """A body that does not turn."""
    body = made.create_dynamic_body(position=tuple(map(float, place)), fixed_rotation=True)
    body.linear_damping, body.linear_velocity = damping, tuple(map(float, speed))
    data = b2d.MassData()
    data.mass, data.center, data.rotational_inertia = float(mass), (0.0, 0.0), 0.0
    body.mass_data = data
    return body


def chain(places, length, density, gravity, held, damping=0.0, stiffness_n=None):
    """A row of masses on joints, or on their springs; those held are static bodies.

    A joint gives way as a spring of 60 Hz does, which pyb2d3 cannot change; a spring of a cable's
    own stiffness is stiffer than that.
    """
    made = world(gravity)
    n = len(places) - 1
    bodies = []
    for k, place in enumerate(places):
        if k in held:
            bodies.append(made.create_static_body(position=tuple(map(float, place))))
        else:
            share = 0.5 if k in (0, n) else 1.0
            bodies.append(mass_at(made, place, density * length / n * share, damping=damping))
    joints = []
    for a, b in zip(bodies, bodies[1:]):
        more = {}
        if stiffness_n:
            # Its spring is told a frequency, of the masses that it joins.
            inverse = sum(1.0 / body.mass for body in (a, b) if body.mass > 0.0)
            hertz = math.sqrt(stiffness_n * n / length * inverse) / (2.0 * math.pi)
            more = {"enable_spring": True, "hertz": hertz, "damping_ratio": 0.0}
        joints.append(made.create_distance_joint(a, b, length=float(length / n), **more))
    return made, bodies, joints


def at_rest(scene, n, dt, substeps, end_s, springs=False):
    """Swings out under a linear damping of 3 a second."""
    length, _, load = scene.warm
    places = guess(scene, n)
    density = scene.density_kg_per_m * scene.length_m / length
    setting = f"N={n} substeps={substeps} dt=1/{round(1 / dt)} to {end_s:g} s"

    def build():
        return chain(places, length, density, load / density, [0, n], damping=3.0,
                     stiffness_n=scene.axial_stiffness_n if springs else None)

    def solve(model):
        made, bodies, _ = model
        pushed = [(bodies[round(s / scene.length_m * n)], tuple(map(float, f))) for s, f in scene.loads]
        for _ in range(round(end_s / dt)):
            for body, force in pushed:
                body.apply_force_to_center(force, True)
            made.step(dt, substeps)
        return model

    (_, bodies, joints), cost = least(build, solve, seconds=0.2)
    now = np.array([tuple(b.position) for b in bodies])
    forces = []
    for link, a, b in ((0, 0, 1), (n - 1, n, n - 1)):
        pull = math.hypot(*joints[link].get_constraint_force())
        forces.append(pull * (now[b] - now[a]) / np.linalg.norm(now[b] - now[a]) + load * 0.5 * length / n)
    arcs = np.linspace(0.0, scene.length_m, n + 1)
    error, shape = scene.errors(forces, max(np.linalg.norm(f) for f in forces), arcs, now)
    if not math.isfinite(error):
        return Point(setting, note="failed: no finite answer")
    kind = "springs " if springs else "joints "
    return Point(kind + setting, cost, error, shape, "" if springs else "links are to be rigid")


def falling(scene_id, n, dt, substeps, springs=False):
    """The swing and the fold."""
    places = scenes.folded(n) if scene_id == "fold" else np.column_stack(
        [np.linspace(0.0, 10.0, n + 1), np.zeros(n + 1)])

    def build():
        return chain(places, 10.0, 1.0, (0.0, -scenes.GRAVITY), [0], stiffness_n=1e7 if springs else None)

    def solve(model):
        made, bodies, _ = model
        seen = []
        for _ in range(round((1.2 if scene_id == "fold" else 1.0) / dt)):
            made.step(dt, substeps)
            seen.append(-bodies[-1].position[1])
        return seen, np.array(tuple(bodies[-1].position))

    (seen, tip), cost = least(build, solve, seconds=0.2)
    if scene_id == "swing":
        error = np.linalg.norm(tip - scenes.SWING_TIP_M) / np.linalg.norm(scenes.SWING_TIP_M)
    else:
        error = abs(scenes.crossing(np.arange(1, len(seen) + 1) * dt, seen, 6.0) / scenes.FOLD_S - 1.0)
    setting = f"N={n} substeps={substeps} dt=1/{round(1 / dt)}"
    if not math.isfinite(error):
        return Point(setting, note="failed: no finite answer")
    kind = "springs " if springs else "joints "
    return Point(kind + setting, cost, float(error), None, "" if springs else "links are to be rigid")


def snap(dt, substeps):
    """A distance joint with a spring of the rope's frequency and no damping."""
    hertz = math.sqrt(scenes.SNAP_EA_N / 10.0 / scenes.SNAP_MASS_KG) / (2.0 * math.pi)

    def build():
        made = world((0.0, -scenes.GRAVITY))
        top = made.create_static_body(position=(0.0, 0.0))
        mass = mass_at(made, (0.0, -10.0), scenes.SNAP_MASS_KG, (0.0, -scenes.SNAP_SPEED))
        joint = made.create_distance_joint(top, mass, length=10.0, enable_spring=True, hertz=hertz, damping_ratio=0.0)
        return made, mass, joint

    def solve(model):
        made, mass, _ = model
        seen = []
        for _ in range(round(1.0 / dt)):
            made.step(dt, substeps)
            seen.append(scenes.SNAP_EA_N * (-mass.position[1] / 10.0 - 1.0))
        return seen

    seen, cost = least(build, solve, seconds=0.2)
    error = abs(scenes.greatest(seen) / scenes.SNAP_PULL_N - 1.0)
    return Point(f"spring substeps={substeps} dt=1/{round(1 / dt)}", cost, error, None, "one spring without mass")


def points(scene_id):
    """All points of a scene."""
    if scene_id in ("hanging-span", "steep-span", "near-taut", "loads-wind-heat"):
        for n in [32, 64] if scene_id == "loads-wind-heat" else [10, 20, 40, 80]:
            for dt, substeps in ((1 / 240, 4), (1 / 960, 4), (1 / 960, 16)):
                yield at_rest(rest(scene_id), n, dt, substeps, 10.0)
            for dt, substeps in ((1 / 240, 16), (1 / 960, 16)):
                yield at_rest(rest(scene_id), n, dt, substeps, 10.0, springs=True)
    elif scene_id in ("swing", "fold"):
        for n in [10, 20, 40, 80] if scene_id == "swing" else [11, 21, 41]:
            for dt, substeps in ((1 / 240, 4), (1 / 240, 16), (1 / 960, 4), (1 / 960, 16), (1 / 3840, 4)):
                yield falling(scene_id, n, dt, substeps)
            for dt, substeps in ((1 / 240, 64), (1 / 960, 16), (1 / 3840, 16)):
                yield falling(scene_id, n, dt, substeps, springs=True)
    elif scene_id == "snap":
        for dt, substeps in ((1 / 240, 4), (1 / 960, 4), (1 / 3840, 4)):
            yield snap(dt, substeps)
    elif scene_id in IN_MOTION:
        yield cannot("not tried")
    else:
        yield cannot("not tried: contact")
