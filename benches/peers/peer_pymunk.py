"""pymunk (Chipmunk2D): point masses on pin joints, sequential impulses; at rest, damped until still."""

import math

import numpy as np
import pymunk

import scenes
from guess import guess
from measure import Point, cannot, least
from scenes import IN_MOTION, rest


def chain(places, length, density, iterations, gravity=(0.0, -scenes.GRAVITY), radius=None, friction=0.5):
    """A row of masses on pin joints, not held; they collide with what is static only."""
    n = len(places) - 1
    space = pymunk.Space()
    space.gravity = tuple(map(float, gravity))
    space.iterations = iterations
    space.bodies_, space.joints_ = [], []
    for k, place in enumerate(places):
        mass = density * length / n * (0.5 if k in (0, n) else 1.0)
        body = pymunk.Body(mass, math.inf)
        body.position = tuple(map(float, place))
        space.add(body)
        space.bodies_.append(body)
        if radius:
            shape = pymunk.Circle(body, radius)
            shape.friction, shape.filter = friction, pymunk.ShapeFilter(group=1)
            shape.collision_type = 1
            space.add(shape)
    for a, b in zip(space.bodies_, space.bodies_[1:]):
        joint = pymunk.PinJoint(a, b)
        joint.distance = length / n
        space.add(joint)
        space.joints_.append(joint)
    return space


def hold(space, k, body=None):
    """Holds a mass where it is, by a pivot; of the pivot the force is read."""
    at = space.bodies_[k].position
    joint = pymunk.PivotJoint(body or space.static_body, space.bodies_[k], at)
    space.add(joint)
    return joint


def fast(space, dt):
    """Joints mend a twentieth of their errors in a step: with a fifth they blow up at small steps."""
    for joint in space.constraints:
        joint.error_bias = 0.95 ** (1.0 / dt)


def floor(space, friction=0.5):
    """A floor, thick as the cable's radius is not: a line at height 0."""
    line = pymunk.Segment(space.static_body, (-20.0, -1.0), (40.0, -1.0), 1.0)
    line.friction, line.collision_type = friction, 2
    space.add(line)
    space.collision_slop = 1e-5


def at_rest(scene, n, iterations, dt, end_s):
    """Swings out, its speed falling by a factor of e³ each second; forces from the last joints."""
    length, _, load = scene.warm
    on_floor = scene.id == "slack-to-floor"
    radius = 0.5 * scene.diameter_m
    places = guess(scene, n, radius if on_floor else None)
    arcs = np.linspace(0.0, scene.length_m, n + 1)
    density = scene.density_kg_per_m * scene.length_m / length
    setting = f"N={n} iterations={iterations} dt=1/{round(1 / dt)} to {end_s} s"

    def build():
        space = chain(places, length, density, iterations, load / density, radius if on_floor else None, 0.0)
        space.ends_ = [hold(space, 0), hold(space, n)]
        if on_floor:
            floor(space, 0.0)
        space.damping = math.exp(-3.0)
        fast(space, dt)
        for s, force in scene.loads:
            body = space.bodies_[round(s / scene.length_m * n)]
            more = np.array(force) / body.mass

            def push(body, gravity, damping, dt, more=more):
                pymunk.Body.update_velocity(body, tuple(np.array(gravity) + more), damping, dt)

            body.velocity_func = push
        return space

    def solve(space):
        for _ in range(round(end_s / dt)):
            space.step(dt)
        return space

    space, cost = least(build, solve, seconds=0.2)
    # The force of a link on its end; half a link's weight is the support's as well.
    now = np.array([b.position for b in space.bodies_])
    forces = []
    for link, a, b in ((0, 0, 1), (n - 1, n, n - 1)):
        pull = space.joints_[link].impulse / dt
        forces.append(pull * (now[b] - now[a]) / np.linalg.norm(now[b] - now[a]) + load * 0.5 * length / n)
    greatest = max(np.linalg.norm(f) for f in forces)
    error, shape = scene.errors(forces, greatest, arcs, now)
    note = "links do not stretch" + ("; friction left out" if on_floor else "")
    return Point(setting, cost, error, shape, note)


def falling(scene_id, n, iterations, dt):
    """The swing and the fold."""
    setting = f"N={n} iterations={iterations} dt=1/{round(1 / dt)}"
    places = scenes.folded(n) if scene_id == "fold" else np.column_stack(
        [np.linspace(0.0, 10.0, n + 1), np.zeros(n + 1)])

    def build():
        space = chain(places, 10.0, 1.0, iterations)
        hold(space, 0)
        fast(space, dt)
        return space

    def solve(space):
        seen = []
        tip = space.bodies_[-1]
        for _ in range(round((1.2 if scene_id == "fold" else 1.0) / dt)):
            space.step(dt)
            seen.append(-tip.position.y)
        return seen, np.array(tip.position)

    (seen, tip), cost = least(build, solve, seconds=0.2)
    if scene_id == "swing":
        error = np.linalg.norm(tip - scenes.SWING_TIP_M) / np.linalg.norm(scenes.SWING_TIP_M)
    else:
        error = abs(scenes.crossing(np.arange(1, len(seen) + 1) * dt, seen, 6.0) / scenes.FOLD_S - 1.0)
    return Point(setting, cost, float(error), None, "links do not stretch")


def snap(dt):
    """A damped spring without damping that only pulls, as it is taut for all of the fall."""
    def build():
        space = pymunk.Space()
        space.gravity = (0.0, -scenes.GRAVITY)
        mass = pymunk.Body(scenes.SNAP_MASS_KG, math.inf)
        mass.position, mass.velocity = (0.0, -10.0), (0.0, -scenes.SNAP_SPEED)
        spring = pymunk.DampedSpring(space.static_body, mass, (0, 0), (0, 0), 10.0, scenes.SNAP_EA_N / 10.0, 0.0)
        space.add(mass, spring)
        space.mass_ = mass
        return space

    def solve(space):
        seen = []
        for _ in range(round(1.0 / dt)):
            space.step(dt)
            seen.append(scenes.SNAP_EA_N * (-space.mass_.position.y / 10.0 - 1.0))
        return seen

    seen, cost = least(build, solve, seconds=0.2)
    error = abs(scenes.greatest(seen) / scenes.SNAP_PULL_N - 1.0)
    return Point(f"spring dt=1/{round(1 / dt)}", cost, error, None, "one spring without mass, as it has them")


def drop(n, iterations, dt):
    """Falls on a floor; its impulse is the sum of those of contacts and of holding pivots."""
    arcs, places = scenes.hung(9.95, 10.0, 1.246, 2e6, n)

    def build():
        space = chain(places + [0.0, 1.0], 10.0, 1.246, iterations, radius=0.014)
        floor(space)
        space.ends_ = [hold(space, 0), hold(space, n)]
        fast(space, dt)
        space.sum_ = 0.0

        def after(arbiter, space, data):
            space.sum_ += abs(arbiter.total_impulse.y)

        space.on_collision(1, 2, post_solve=after)
        return space

    def solve(space):
        held = space.ends_
        for k in range(round(0.9 / dt)):
            space.step(dt)
            if held:
                # A pivot tells the size of its impulse; the chain hangs steeply by half its weight.
                for j, link, a, b in ((0, 0, 0, 1), (1, n - 1, n, n - 1)):
                    d = space.bodies_[b].position - space.bodies_[a].position
                    down = space.joints_[link].impulse * -d.y / d.length
                    space.sum_ += down + space.bodies_[a].mass * scenes.GRAVITY * dt
                if (k + 1) * dt >= scenes.LET_GO_S - 1e-9:
                    space.remove(*held)
                    held = []
        return space.sum_

    impulse, cost = least(build, solve, seconds=0.2)
    error = abs(impulse / (0.9 * 10.0 * 1.246 * scenes.GRAVITY) - 1.0)
    return Point(f"N={n} iterations={iterations} dt=1/{round(1 / dt)}", cost, error, None, "links do not stretch")


def drag(n, iterations, dt):
    """A tail on a floor behind a hand that moves."""
    lying, low = 5.3, 0.014
    up = math.sqrt(1.3**2 - (0.35 - low) ** 2)
    arcs = np.linspace(0.0, 6.6, n + 1)
    places = np.column_stack([
        np.where(arcs < lying, 6.0 - up - lying + arcs, 6.0 - up + (arcs - lying) / 1.3 * up),
        np.where(arcs < lying, low, low + (arcs - lying) / 1.3 * (0.35 - low)),
    ])

    def build():
        space = chain(places, 6.6, 1.246, iterations, radius=low)
        floor(space, 1.0)
        hand = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
        hand.position = (6.0, 0.35)
        space.add(hand)
        hold(space, n, hand)
        space.hand_ = hand
        fast(space, dt)
        return space

    def solve(space):
        pulls, t = [], 0.0
        mass = space.bodies_[-1].mass
        for k in range(round(6.0 / dt)):
            there = scenes.hand_of_drag(t + dt)[0]
            space.hand_.velocity = ((there - space.hand_.position.x) / dt, 0.0)
            space.step(dt)
            t += dt
            if t > 4.0:
                d = space.bodies_[-2].position - space.bodies_[-1].position
                f = space.joints_[-1].impulse / dt
                pulls.append(math.hypot(f * d.x / d.length, f * d.y / d.length - mass * scenes.GRAVITY))
        return np.mean(pulls)

    pull, cost = least(build, solve, seconds=0.1)
    setting = f"N={n} iterations={iterations} dt=1/{round(1 / dt)}"
    return Point(setting, cost, abs(pull / scenes.DRAG_PULL_N - 1.0), None, "links do not stretch")


def points(scene_id):
    """All points of a scene."""
    if scene_id in ("hanging-span", "steep-span", "slack-to-floor", "near-taut", "loads-wind-heat"):
        meshes = [32, 64] if scene_id == "loads-wind-heat" else [10, 20, 40]
        for n in meshes:
            for iterations in (20, 100, 500):
                yield at_rest(rest(scene_id), n, iterations, 1 / 480, 5.0)
        yield at_rest(rest(scene_id), meshes[-1], 500, 1 / 960, 10.0)
    elif scene_id in ("swing", "fold"):
        for n in [10, 20, 40] if scene_id == "swing" else [11, 21, 41]:
            for iterations, dt in ((20, 1 / 240), (100, 1 / 960), (20, 1 / 3840), (100, 1 / 3840), (100, 1 / 15360)):
                yield falling(scene_id, n, iterations, dt)
    elif scene_id == "snap":
        for dt in (1 / 240, 1 / 960, 1 / 3840, 1 / 15360):
            yield snap(dt)
    elif scene_id == "drop":
        for n, iterations, dt in ((42, 20, 1 / 240), (42, 50, 1 / 960), (84, 50, 1 / 960), (84, 50, 1 / 3840)):
            yield drop(n, iterations, dt)
    elif scene_id == "drag":
        for n, iterations, dt in ((30, 20, 1 / 240), (30, 50, 1 / 960), (60, 100, 1 / 960), (60, 100, 1 / 3840)):
            yield drag(n, iterations, dt)
    elif scene_id in IN_MOTION:
        yield cannot("not tried")
    else:
        yield cannot("friction at rest depends on the laying, or no pulley: not tried")
