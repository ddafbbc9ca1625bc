"""One peer and one scene, in a process of its own: `one.py PEER SCENE`."""

import importlib
import resource
import sys

from measure import cannot, tell

# A peer may spend so much CPU on a scene, s.
CPU_LIMIT_S = 60


def main():
    peer, scene = sys.argv[1:3]
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_LIMIT_S, CPU_LIMIT_S + 5))
    try:
        for point in importlib.import_module(f"peer_{peer}").points(scene):
            tell(point)
    except Exception as error:
        tell(cannot(f"failed: {type(error).__name__}: {error}".replace("\n", " ")[:160]))
        raise


main()
