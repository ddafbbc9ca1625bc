"""MuJoCo: a plane chain of rigid links on hinges, its ends held by soft equalities; at rest, damped until still."""

import math

import mujoco
import numpy as np

import scenes
from guess import guess
from measure import Point, cannot, least
from scenes import IN_MOTION, rest

# Steps in which a soft constraint mends its error; two is the least that MuJoCo allows.
STIFF_STEPS = 2.0
# Drag of the medium at rest, Pa s: damped hinges alone leave the slow swings of a long chain.
VISCOSITY = 0.5

# A body at a node, for forces, which act on the middles of bodies.
POINT = '<body name="p{}"><inertial pos="0 0 0" mass="1e-9" diaginertia="1e-9 1e-9 1e-9"/></body>'


def chain_xml(places, length, density, gravity, dt, integrator, free_root, ends, radius=0.0, friction=0.0,
              damping=0.0, hand=None, floor=False, viscosity=0.0, mend_s=None, loaded=()):
    """The model: link k between node k and k + 1, turned by hinges about y."""
    n = len(places) - 1
    part = length / n
    angles = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in zip(places, places[1:])]
    # A link is a uniform rod.
    mass = density * part
    size, tail = max(radius, 1e-3), ""
    links = []
    last = 0.0
    for k, angle in enumerate(angles):
        turn = -math.degrees(angle - last)
        at = f"{places[0][0]} 0 {places[0][1]}" if k == 0 else f"{part} 0 0"
        joints = f'<joint type="hinge" axis="0 1 0" damping="{damping}" armature="0"/>'
        if k == 0 and free_root:
            slides = '<joint type="slide" axis="{}" damping="0"/>'
            joints = slides.format("1 0 0") + slides.format("0 0 1") + joints
        inertia = mass * part**2 / 12.0
        links.append(f'<body name="b{k}" pos="{at}" euler="0 {turn} 0">{joints}'
                     f'<inertial pos="{part / 2} 0 0" mass="{mass}" diaginertia="{inertia} {inertia} {inertia}"/>'
                     + (f'<geom type="sphere" size="{size}" pos="0 0 0" friction="{friction} 0 0"/>' if floor else "")
                     + (POINT.format(k) if k in loaded else "")
                     + f'<site name="s{k}" pos="0 0 0"/>')
        last = angle
    tail = f'<site name="s{n}" pos="{part} 0 0"/>'
    if floor:
        tail += f'<geom type="sphere" size="{size}" pos="{part} 0 0" friction="{friction} 0 0"/>'
    soft = f'solref="{mend_s or STIFF_STEPS * dt} 1" solimp="0.9999 0.9999 0.001 0.5 2"'
    held = []
    for k in ends:
        body, x = (f"b{k}", 0.0) if k < n else (f"b{n - 1}", part)
        other = f'body2="{hand}"' if hand and k == n else ""
        held.append(f'<connect name="e{k}" body1="{body}" anchor="{x} 0 0" {other} {soft}/>')
    ground = f'<geom type="plane" size="50 50 1" pos="0 0 0" friction="{friction} 0 0"/>' if floor else ""
    mocap = f'<body name="{hand}" mocap="true" pos="{places[-1][0]} 0 {places[-1][1]}"/>' if hand else ""
    return f"""<mujoco><option timestep="{dt}" gravity="{gravity[0]} 0 {gravity[1]}" integrator="{integrator}" viscosity="{viscosity}"
      cone="elliptic" solver="Newton" tolerance="1e-12" iterations="100"/>
      <compiler angle="degree" autolimits="true"/>
      <default><geom contype="1" conaffinity="2" condim="3" {soft}/></default>
      <worldbody>{ground.replace('type="plane"', 'type="plane" contype="2" conaffinity="1"')}{mocap}
      {"".join(links)}{tail}{"</body>" * n}</worldbody>
      <equality>{"".join(held)}</equality></mujoco>"""


def ready(xml):
    """Model and data, no more than compiled."""
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def nodes(data, n):
    """Places of the nodes, m."""
    return data.site_xpos[: n + 1][:, [0, 2]].copy()


def held_force(model, data, row):
    """The force of the cable on what an equality holds it by: its three rows."""
    rows = [k for k in range(data.nefc) if data.efc_type[k] == mujoco.mjtConstraint.mjCNSTR_EQUALITY]
    return data.efc_force[rows[3 * row: 3 * row + 3]][[0, 2]].copy()


def at_rest(scene, n, dt, end_s):
    """Both ends held by equalities, hinges damped; loads are applied forces."""
    length, _, load = scene.warm
    on_floor = scene.id == "slack-to-floor"
    radius = 0.5 * scene.diameter_m
    places = guess(scene, n, radius if on_floor else None)
    density = scene.density_kg_per_m * scene.length_m / length
    xml = chain_xml(places, length, density, load / density, dt, "implicitfast", True, [0, n],
                    radius, 0.0, 0.01, floor=on_floor, viscosity=VISCOSITY,
                    loaded=[round(s / scene.length_m * n) for s, _ in scene.loads])
    setting = f"N={n} dt=1/{round(1 / dt)} to {end_s} s"

    def build():
        model, data = ready(xml)
        for s, force in scene.loads:
            k = round(s / scene.length_m * n)
            data.xfrc_applied[model.body(f"p{k}").id][[0, 2]] = force
        return model, data

    def solve(both):
        model, data = both
        mujoco.mj_step(model, data, nstep=round(end_s / dt))
        return both

    (model, data), cost = least(build, solve, seconds=0.2)
    forces = np.array([held_force(model, data, 0), held_force(model, data, 1)])
    if forces.sum(0) @ load < 0:
        forces = -forces
    note = "links do not stretch"
    if scene.id == "near-taut":
        note += ": a fifth of this tension hangs on that"
    note += "; friction left out" if on_floor else ""
    arcs = np.linspace(0.0, scene.length_m, n + 1)
    error, shape = scene.errors(forces, max(np.linalg.norm(forces, axis=1)), arcs, nodes(data, n))
    if not math.isfinite(error):
        return Point(setting, note="failed: no finite answer")
    return Point(setting, cost, error, shape, note)


def falling(scene_id, n, dt, integrator):
    """The swing and the fold: the first hinge stands still."""
    places = scenes.folded(n) if scene_id == "fold" else np.column_stack(
        [np.linspace(0.0, 10.0, n + 1), np.zeros(n + 1)])
    xml = chain_xml(places, 10.0, 1.0, [0.0, -scenes.GRAVITY], dt, integrator, False, [])
    setting = f"{integrator} N={n} dt=1/{round(1 / dt)}"

    def solve(both):
        model, data = both
        seen = []
        for _ in range(round((1.2 if scene_id == "fold" else 1.0) / dt)):
            mujoco.mj_step(model, data)
            if scene_id == "fold":
                # Sites are of the step's start: one step late.
                seen.append(-data.site_xpos[n, 2])
        mujoco.mj_forward(model, data)
        return seen, data.site_xpos[n][[0, 2]].copy()

    (seen, tip), cost = least(lambda: ready(xml), solve, seconds=0.2)
    if scene_id == "swing":
        error = np.linalg.norm(tip - scenes.SWING_TIP_M) / np.linalg.norm(scenes.SWING_TIP_M)
    else:
        error = abs(scenes.crossing(np.arange(len(seen)) * dt, seen, 6.0) / scenes.FOLD_S - 1.0)
    if not math.isfinite(error):
        return Point(setting, note="failed: no finite answer")
    return Point(setting, cost, float(error), None, "links do not stretch")


def snap(dt, integrator):
    """A spatial tendon with a stiffness and a slack range."""
    xml = f"""<mujoco><option timestep="{dt}" gravity="0 0 {-scenes.GRAVITY}" integrator="{integrator}"/>
      <worldbody><site name="top"/><body name="m" pos="0 0 -10"><joint type="slide" axis="0 0 1"/>
      <inertial pos="0 0 0" mass="{scenes.SNAP_MASS_KG}" diaginertia="1 1 1"/><site name="low"/></body></worldbody>
      <tendon><spatial stiffness="{scenes.SNAP_EA_N / 10.0}" springlength="0 10"><site site="top"/><site site="low"/>
      </spatial></tendon></mujoco>"""

    def build():
        model, data = ready(xml)
        data.qvel[0] = -scenes.SNAP_SPEED
        return model, data

    def solve(both):
        model, data = both
        seen = []
        for _ in range(round(1.0 / dt)):
            mujoco.mj_step(model, data)
            seen.append(-data.qpos[0] * scenes.SNAP_EA_N / 10.0)
        return seen

    seen, cost = least(build, solve, seconds=0.2)
    error = abs(scenes.greatest(seen) / scenes.SNAP_PULL_N - 1.0)
    return Point(f"tendon {integrator} dt=1/{round(1 / dt)}", cost, float(error), None, "one tendon without mass")


def drop(n, dt):
    """Falls on a plane; the root's slides feel all that floor and equalities give."""
    _, places = scenes.hung(9.95, 10.0, 1.246, 2e6, n)
    xml = chain_xml(places + [0.0, 1.0], 10.0, 1.246, [0.0, -scenes.GRAVITY], dt, "implicitfast", True, [0, n],
                    0.014, 0.5, floor=True)

    def solve(both):
        model, data = both
        total = 0.0
        for k in range(round(0.9 / dt)):
            mujoco.mj_step(model, data)
            total += data.qfrc_constraint[1] * dt
            if (k + 1) * dt >= scenes.LET_GO_S - 1e-9:
                data.eq_active[:] = 0
        return total

    impulse, cost = least(lambda: ready(xml), solve, seconds=0.2)
    error = abs(impulse / (0.9 * 10.0 * 1.246 * scenes.GRAVITY) - 1.0)
    return Point(f"N={n} dt=1/{round(1 / dt)}", cost, float(error), None, "links do not stretch")


def drag(n, dt):
    """A tail on a plane behind a mocap body.

    Constraints as soft as MuJoCo's own default: as stiff as two steps the chain hops over the floor.
    """
    lying, low = 5.3, 0.014
    up = math.sqrt(1.3**2 - (0.35 - low) ** 2)
    arcs = np.linspace(0.0, 6.6, n + 1)
    places = np.column_stack([
        np.where(arcs < lying, 6.0 - up - lying + arcs, 6.0 - up + (arcs - lying) / 1.3 * up),
        np.where(arcs < lying, low, low + (arcs - lying) / 1.3 * (0.35 - low)),
    ])
    xml = chain_xml(places, 6.6, 1.246, [0.0, -scenes.GRAVITY], dt, "implicitfast", True, [n], low, 0.5,
                    damping=0.01, hand="hand", floor=True, mend_s=0.02)

    def solve(both):
        model, data = both
        pulls = []
        for k in range(round(6.0 / dt)):
            data.mocap_pos[0, 0] = scenes.hand_of_drag((k + 1) * dt)[0]
            mujoco.mj_step(model, data)
            if data.time > 4.0:
                pulls.append(np.linalg.norm(held_force(model, data, 0)))
        return np.mean(pulls)

    pull, cost = least(lambda: ready(xml), solve, seconds=0.1)
    error = abs(pull / scenes.DRAG_PULL_N - 1.0)
    return Point(f"N={n} dt=1/{round(1 / dt)}", cost, float(error), None, "links do not stretch")


def points(scene_id):
    """All points of a scene."""
    if scene_id in ("hanging-span", "steep-span", "near-taut", "slack-to-floor", "loads-wind-heat"):
        for n in [32, 64] if scene_id == "loads-wind-heat" else [10, 20, 40]:
            for dt in (1 / 240, 1 / 960):
                yield at_rest(rest(scene_id), n, dt, 10.0)
    elif scene_id in ("swing", "fold"):
        for integrator, dt in (("Euler", 1 / 240), ("Euler", 1 / 3840), ("RK4", 1 / 240), ("RK4", 1 / 960)):
            for n in [10, 20, 40] if scene_id == "swing" else [11, 21, 41]:
                yield falling(scene_id, n, dt, integrator)
    elif scene_id == "snap":
        for integrator in ("Euler", "RK4"):
            for dt in (1 / 240, 1 / 960, 1 / 3840):
                yield snap(dt, integrator)
    elif scene_id == "drop":
        for n, dt in ((42, 1 / 240), (42, 1 / 960)):
            yield drop(n, dt)
    elif scene_id == "drag":
        for n, dt in ((30, 1 / 240), (30, 1 / 960), (60, 1 / 480), (60, 1 / 960)):
            yield drag(n, dt)
    elif scene_id in IN_MOTION:
        yield cannot("not tried: its tendons wrap without friction")
    else:
        yield cannot("friction at rest depends on the laying, or no pulley: not tried")
