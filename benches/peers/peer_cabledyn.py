"""CableDyn: finite elements of two kinds, Newton with load continuation, generalized alpha."""

import os
import resource
import subprocess
import tempfile
import time
from pathlib import Path

import cabledyn
import numpy as np
from cabledyn import CableDyn, CableDynError

import scenes
from measure import Point, cannot, least
from scenes import IN_MOTION, rest

# Water as thin as it may be asked, and so deep that all of a span is in it and off its bed.
THIN_KG_PER_M3 = 1e-9
DEEP_M = 1000.0
# The bed pushes by so much for each square metre of cable and each metre of depth, N/m³.
BED_N_PER_M3 = 1e7
# Bending of the second kind of element, cubic in place: little, as the cables have none.
BENDING_N_M2 = 1e-5
# How long a fold is followed, s.
FOLD_END_S = 1.1
SPANS = ["hanging-span", "near-taut", "steep-span"]

INPUT = """--- CableDyn Input File ---
benches/peers
--- LINE TYPES ---
TypeName Diam MassDenInAir EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
cable {diameter} {density!r} {stiffness!r} 0 {bending} 0 0 0 0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (mm^3) (m^2) (-)
1 Coupled {ax!r} 0 {az!r} 0 0 0 0
2 Fixed {bx!r} 0 {bz!r} 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(#) (name) (#) (#) (m) (-) (-)
1 cable 1 2 {length!r} {n} -
{failure}--- OPTIONS ---
{thin} WtrDnsty
{gravity} g
{depth!r} WtrDpth
{bed} kBot
0 cBot
{steps}{outputs}--- END ---
"""


def written(**given):
    """An input file, as CableDyn wants it."""
    whole = {"bending": 0, "thin": THIN_KG_PER_M3, "gravity": scenes.GRAVITY, "depth": DEEP_M, "bed": BED_N_PER_M3,
             "steps": "", "failure": "", "outputs": "", **given}
    if whole["bending"]:
        # A line with bending is not read without steps, though none is taken.
        whole["steps"] = "0.01 dtM\n1 TMax\n"
    path = os.path.join(tempfile.mkdtemp(prefix="cabledyn-"), "in.dat")
    with open(path, "w") as file:
        file.write(INPUT.format(**whole))
    return path


def at_rest(scene, n, bending=0.0):
    """Both ends held; the answer is the balance that it begins its own simulations from."""
    length, stiffness, load = scene.warm
    floor = scene.id == "slack-to-floor"
    # The bed carries the line's axis: it lies a radius above the floor.
    lift = np.array([0.0, -DEEP_M - (0.5 * scene.diameter_m if floor else -0.5 * DEEP_M)])
    (ax, az), (bx, bz) = (end + lift for end in scene.ends)
    path = written(
        diameter=scene.diameter_m, density=float(-load[1] / scenes.GRAVITY), stiffness=float(stiffness),
        bending=bending, ax=float(ax), az=float(az), bx=float(bx), bz=float(bz), length=float(length), n=n,
    )

    def solve(model):
        model.init_deck(path)
        return model

    setting = f"N={n}" + (f" EI={bending:g}" if bending else "")
    try:
        model, cost = least(CableDyn, solve, seconds=0.3)
    except CableDynError as error:
        return Point(setting, note=f"failed: {error}".replace("\n", " ")[:160])
    line = model.lines[0]
    # It says how hard the second end is pulled level, and not whither: towards the first.
    level, upright = model.channels(["AnchFH1", "AnchFz1"])
    forces = [model.calc_output()[[0, 2]], np.array([np.copysign(level, ax - bx), upright])]
    tension = max([line.segment_tensions().max(), *(np.linalg.norm(f) for f in forces)])
    places = line.node_positions()[:, [0, 2]] - lift
    # A line with bending may get elements that were not asked for.
    asked = line.deck_nodes
    arcs = scene.length_m * (asked[asked > 0] - 1) / n
    error, shape = scene.errors(forces, tension, arcs, places[asked > 0])
    elements = line.n_segments
    model.close()
    if not np.isfinite(error):
        return Point(setting, note="failed: no finite answer")
    notes = ["floor of springs; friction left out"] if floor else []
    if elements != n:
        notes.append(f"refined by it to {elements} elements")
    return Point(setting, cost, float(error), float(shape), "; ".join(notes))


FAILURE = """--- FAILURE ---
FailID Point Line(s) FailTime FailTen
(-) (-) (-) (s) (N)
1 P2 1 {at!r} 0
"""


def fold(n, part):
    """An end let go, by its program: its library lets no end go."""
    length, density, stiffness = 10.0, 1.0, 1e7
    # Whole steps fill its time.
    dt = FOLD_END_S / round(FOLD_END_S / (part * length / n / float(np.sqrt(stiffness / density))))
    # It lets go after the step within which the time lies, the first.
    common = {
        "diameter": 0.028, "density": density, "stiffness": stiffness, "ax": 0.0, "az": -0.5 * DEEP_M,
        "bx": length / n, "bz": -0.5 * DEEP_M, "length": length, "n": n, "failure": FAILURE.format(at=0.5 * dt),
        "outputs": f"--- OUTPUTS ---\nL1N{n + 1}pz\n",
    }

    def run(end_s):
        path = written(steps=f"{dt!r} dtM\n{end_s!r} TMax\n", **common)
        where, program = Path(path).parent, Path(cabledyn.__file__).parent / "bin/cabledyn"
        cpu, wall = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        subprocess.run([program, path, "out"], cwd=where, check=True, capture_output=True)
        wall, after = time.perf_counter() - wall, resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime - cpu.ru_utime + after.ru_stime - cpu.ru_stime
        return where / "out.out", min(wall, cpu)

    start = min(run(2.0 * dt)[1] for _ in range(3))
    table, cost = run(FOLD_END_S)
    if cost < 1.0:
        cost = min(cost, *(run(FOLD_END_S)[1] for _ in range(2)))
    rows = np.loadtxt(table, skiprows=2)
    fallen = scenes.crossing(rows[:, 0] - dt, -0.5 * DEEP_M - rows[:, 1], 6.0)
    setting = f"N={n} dt={part:g}l/c"
    if not np.isfinite(fallen):
        return Point(setting, note="failed: has not fallen 6 m")
    return Point(setting, cost - start, float(abs(fallen / scenes.FOLD_S - 1.0)), None,
                 "its program, less a run of two steps")


def points(scene_id):
    """All points of a scene."""
    if scene_id in SPANS or scene_id == "slack-to-floor":
        scene = rest(scene_id)
        for bending in (0.0, BENDING_N_M2):
            for n in [10, 20, 40, 80]:
                yield at_rest(scene, n, bending)
    elif scene_id == "loads-wind-heat":
        yield cannot("not tried: wind is a drag, a load aslant is one on a rigid body")
    elif scene_id == "fold":
        for n in [11, 21, 41]:
            for part in (1.0, 0.5, 0.25) if n < 41 else (1.0, 0.5):
                yield fold(n, part)
    elif scene_id == "drag":
        yield cannot("no friction on its seabed where an end is free")
    elif scene_id in ("drop", "capstan-half"):
        yield cannot("no obstacles but a seabed")
    elif scene_id in IN_MOTION:
        yield cannot("begins from its own balance and cannot be told a shape")
    else:
        yield cannot("no obstacles but a seabed, no pulleys")
