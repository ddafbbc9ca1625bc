"""The shape from which solvers at rest begin: as anyone would draw it."""

import numpy as np
from scipy.optimize import brentq


def guess(scene, n, floor_m=None):
    """A parabola between the ends, a little longer than the cable, at equal parts of its length.

    Above a floor the rest of it lies on that.
    """
    length, _, load = scene.warm
    return sagging(*scene.ends, length, load / np.linalg.norm(load), n, floor_m)


def sagging(start, end, length, down, n, floor_m=None):
    """The same between two points."""
    u = np.linspace(0.0, 1.0, 2001)

    def shape(sag):
        places = start + np.outer(u, end - start) + np.outer(4 * sag * u * (1 - u), down)
        if floor_m is not None:
            places[:, 1] = np.maximum(places[:, 1], floor_m)
        return places

    long = lambda sag: np.linalg.norm(np.diff(shape(sag), axis=0), axis=1).sum()
    sag = brentq(lambda sag: long(sag) - length * (1.0 + 1e-4), 0.0, 100.0 * length)
    at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(shape(sag), axis=0), axis=1))])
    even = np.linspace(0.0, at[-1], n + 1)
    return np.column_stack([np.interp(even, at, shape(sag)[:, i]) for i in range(2)])
