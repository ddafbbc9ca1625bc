"""One peer and one scene, in a process of its own: `one.py PEER SCENE`."""

import importlib
import resource
import sys

from measure import Point, cannot, tell

# An answer that is off by more than what is asked is none: Newton ends so where it finds another balance.
FAR_OFF = 1.0
# A peer may spend so much CPU on a scene, s.
CPU_LIMIT_S = 60


def main():
    peer, scene = sys.argv[1:3]
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_LIMIT_S, CPU_LIMIT_S + 5))
    try:
        for point in importlib.import_module(f"peer_{peer}").points(scene):
            if point.error is not None and not point.error < FAR_OFF:
                why = f"failed: an answer with an error of {point.error:.3g}"
                point = Point(point.setting, note="; ".join(filter(None, [why, point.note])))
            tell(point)
    except Exception as error:
        tell(cannot(f"failed: {type(error).__name__}: {error}".replace("\n", " ")[:160]))
        raise


main()
