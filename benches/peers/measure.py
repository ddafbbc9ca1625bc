"""How a peer's points are timed and handed to the driver."""

import json
import time
from dataclasses import asdict, dataclass


@dataclass
class Point:
    """One line of the table, without scene and peer; no figures where the peer failed."""

    setting: str
    cost_s: float | None = None
    error: float | None = None
    shape_error: float | None = None
    note: str = ""


def least(build, solve, seconds=0.5, most=200):
    """What `solve(build())` answers, and the least of its times; `build` is not timed.

    Of elapsed and CPU time of the one thread the smaller counts, so that other programs on the
    machine do not count against the peer.
    """
    best, spent, done = float("inf"), 0.0, 0
    while done < 3 or (spent < seconds and done < most):
        if done and spent > 6.0 * seconds:
            break
        model = build()
        cpu, wall = time.process_time(), time.perf_counter()
        answer = solve(model)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        best = min(best, wall, cpu) if cpu > 1e-3 else min(best, wall)
        spent += wall
        done += 1
    return answer, best


def cannot(why):
    """A line without figures."""
    return Point("", note=why)


def tell(point):
    """Hands a point to the driver at once, so that a later failure does not lose it."""
    print("POINT " + json.dumps(asdict(point)), flush=True)
