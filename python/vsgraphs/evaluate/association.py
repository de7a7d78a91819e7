"""Which estimated pose belongs to which true pose."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vsgraphs.trajectory import Array

Indices = npt.NDArray[np.intp]

# Farther apart in time, two poses are not of the same instant. The default of the program evo.
MAX_DT_S = 0.01


def associate(estimate: Array, truth: Array, max_dt_s: float = MAX_DT_S) -> tuple[Indices, Indices]:
    """Indices of matching timestamps; both lists ascending, seconds.

    For each of the list with fewer, the nearest of the other at most `max_dt_s` away, the earlier where two
    are equally near. This is the pairing of the program evo, so that figures can be compared; it may pair
    one pose of the longer list twice.
    """
    if len(estimate) <= len(truth):
        return _nearest(estimate, truth, max_dt_s)
    in_truth, in_estimate = _nearest(truth, estimate, max_dt_s)
    return in_estimate, in_truth


def _nearest(few: Array, many: Array, max_dt_s: float) -> tuple[Indices, Indices]:
    if not len(few) or not len(many):
        return np.zeros(0, np.intp), np.zeros(0, np.intp)
    right = np.clip(np.searchsorted(many, few), 0, len(many) - 1)
    left = np.clip(right - 1, 0, len(many) - 1)
    nearest = np.where(np.abs(many[left] - few) <= np.abs(many[right] - few), left, right)
    close = np.abs(many[nearest] - few) <= max_dt_s
    return np.flatnonzero(close), nearest[close]
