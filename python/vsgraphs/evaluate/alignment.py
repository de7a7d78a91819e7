"""Rigid alignment of two point sets, without scale.

Umeyama, "Least-squares estimation of transformation parameters between two point patterns", PAMI 1991.
"""

from __future__ import annotations

import numpy as np

from vsgraphs.trajectory import Array


def umeyama(source: Array, target: Array) -> Array:
    """(N, 3) and (N, 3) -> (4, 4) rigid transform that takes `source` closest to `target` in least squares.

    At least 3 points are expected; where they lie on a line the turn about it is arbitrary.
    """
    mean_source, mean_target = source.mean(axis=0), target.mean(axis=0)
    covariance = (target - mean_target).T @ (source - mean_source) / len(source)
    u, _, vt = np.linalg.svd(covariance)
    mirror = np.eye(3)
    mirror[2, 2] = np.sign(np.linalg.det(u) * np.linalg.det(vt))
    transform = np.eye(4)
    transform[:3, :3] = u @ mirror @ vt
    transform[:3, 3] = mean_target - transform[:3, :3] @ mean_source
    return transform
