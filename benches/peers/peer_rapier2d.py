"""rapier2d in double precision: uniform rods on revolute joints, solved by impulses or as one multibody."""

import json
import math
import subprocess

import numpy as np

import scenes
from measure import Point, cannot
from scenes import IN_MOTION, ROOT

PROGRAM = ROOT / "target/rapier2d/release/peer-rapier2d"


def falling(scene_id, kind, n, dt, iterations):
    """The swing and the fold; the program itself takes the least of three times."""
    places = scenes.folded(n) if scene_id == "fold" else np.column_stack(
        [np.linspace(0.0, 10.0, n + 1), np.zeros(n + 1)])
    end_s = 1.2 if scene_id == "fold" else 1.0
    words = [kind, str(n), repr(dt), str(iterations), repr(end_s), *(repr(float(x)) for x in places.ravel())]
    done = subprocess.run([str(PROGRAM), *words], capture_output=True, text=True, check=True)
    found = json.loads(done.stdout)
    tips = np.array(found["tip_m"])
    setting = f"{kind} N={n} iterations={iterations} dt=1/{round(1 / dt)}"
    if not np.isfinite(tips).all():
        return Point(setting, note="failed: no finite answer")
    if scene_id == "swing":
        error = np.linalg.norm(tips[-1] - scenes.SWING_TIP_M) / np.linalg.norm(scenes.SWING_TIP_M)
    else:
        error = abs(scenes.crossing(np.arange(1, len(tips) + 1) * dt, -tips[:, 1], 6.0) / scenes.FOLD_S - 1.0)
    if not math.isfinite(error):
        return Point(setting, note="failed: no finite answer")
    return Point(setting, found["cost_s"], float(error), None, "links are rigid")


def points(scene_id):
    """All points of a scene."""
    if not PROGRAM.exists():
        yield cannot("its program is not built here")
    elif scene_id in ("swing", "fold"):
        for n in [10, 20, 40, 80] if scene_id == "swing" else [11, 21, 41]:
            for dt, iterations in ((1 / 240, 4), (1 / 240, 16), (1 / 960, 4), (1 / 3840, 4)):
                yield falling(scene_id, "impulse", n, dt, iterations)
            if n <= 41:
                for dt in (1 / 240, 1 / 960):
                    yield falling(scene_id, "multibody", n, dt, 4)
    elif scene_id in IN_MOTION:
        yield cannot("not tried")
    else:
        yield cannot("cannot: elastic cables at rest; its links are rigid")
