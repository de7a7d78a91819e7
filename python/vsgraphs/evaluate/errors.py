"""Trajectory errors: absolute (ATE) and relative (RPE), after Sturm et al., IROS 2012.

ATE: distances between aligned estimated and true camera centres at the paired instants, metres.

RPE: for each paired pose i, the first later paired pose j at least 1 m of true path (or 1 s) on. The error
of the estimated motion between them is E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), Q true, P estimated. Its
translation and its rotation angle are divided by the true path (or time) from i to j: metres per metre and
degrees per metre (metres and degrees per second). Needs no alignment. The path is the sum of distances
between consecutive paired true poses.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vsgraphs.trajectory import Array


@dataclass(frozen=True)
class Statistics:
    """Of a set of errors, in their unit."""

    rmse: float
    mean: float
    median: float
    max: float
    count: int


@dataclass(frozen=True)
class RelativeError:
    """RPE: translation in metres and rotation in degrees, each per metre or per second."""

    translation: Statistics
    rotation_deg: Statistics


def statistics(errors: Array) -> Statistics:
    """Statistics of (N,) errors, N at least 1."""
    return Statistics(
        float(np.sqrt(np.mean(errors**2))),
        float(np.mean(errors)),
        float(np.median(errors)),
        float(np.max(errors)),
        len(errors),
    )


def path_m(positions: Array) -> Array:
    """(N, 3) -> (N,) distance travelled until each position, metres."""
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def relative_error(estimate: Array, truth: Array, progress: Array, delta: float) -> RelativeError | None:
    """RPE over pairs at least `delta` apart in `progress` ((N,) path in metres or time in seconds).

    estimate, truth: (N, 4, 4) paired poses. None where the trajectory is shorter than `delta`.
    """
    first, second = _pairs(progress, delta)
    if not len(first):
        return None
    true_motion = np.linalg.inv(truth[first]) @ truth[second]
    motion = np.linalg.inv(estimate[first]) @ estimate[second]
    error = np.linalg.inv(true_motion) @ motion
    per = progress[second] - progress[first]
    translation = np.linalg.norm(error[:, :3, 3], axis=1)
    rotation = np.degrees(rotation_angles(error[:, :3, :3]))
    return RelativeError(statistics(translation / per), statistics(rotation / per))


def rotation_angles(rotations: Array) -> Array:
    """(N, 3, 3) -> (N,) angles in radians, exact near 0 and near pi."""
    r = rotations
    axis = np.stack([r[:, 2, 1] - r[:, 1, 2], r[:, 0, 2] - r[:, 2, 0], r[:, 1, 0] - r[:, 0, 1]], axis=1)
    angles: Array = np.arctan2(np.linalg.norm(axis, axis=1), np.trace(r, axis1=1, axis2=2) - 1.0)
    return angles


def _pairs(progress: Array, delta: float) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    # A part in 10^9: a clock that ticks exactly `delta` must not miss its own tick by rounding.
    second = np.searchsorted(progress, progress + delta * (1 - 1e-9), side="left")
    # Where numbers are so large that `delta` is lost in them, a pose would be its own successor.
    first = np.flatnonzero((second < len(progress)) & (second > np.arange(len(progress))))
    return first, second[first]
