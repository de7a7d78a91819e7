"""Compares an estimated trajectory with the truth."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vsgraphs.errors import InputError
from vsgraphs.evaluate.alignment import umeyama
from vsgraphs.evaluate.association import MAX_DT_S, associate
from vsgraphs.evaluate.errors import RelativeError, Statistics, path_m, relative_error, statistics
from vsgraphs.timestamps import pair_by_time, smallest_gap
from vsgraphs.trajectory import Array, Trajectory

MIN_PAIRS = 3


@dataclass
class Evaluation:
    """Errors of an estimate.

    `aligned`: (N, 4, 4) paired estimated poses in the truth's frame; `truth`: their true poses; `errors_m`:
    (N,) distances between them. `completion`: see `evaluate`; None where it cannot be known.
    """

    pairs: int
    path_m: float
    duration_s: float
    ate: Statistics
    rpe_per_metre: RelativeError | None
    rpe_per_second: RelativeError | None
    completion: float | None
    alignment: Array
    aligned: Array
    truth: Array
    errors_m: Array
    notes: list[str] = field(default_factory=list)

    def to_json(self) -> dict[str, Any]:
        """Plain values, units in the names."""
        return {
            "pairs": self.pairs,
            "path_m": self.path_m,
            "duration_s": self.duration_s,
            "ate": {
                "rmse_m": self.ate.rmse,
                "mean_m": self.ate.mean,
                "median_m": self.ate.median,
                "max_m": self.ate.max,
            },
            "rpe": {
                "per_metre": _relative_json(self.rpe_per_metre),
                "per_second": _relative_json(self.rpe_per_second),
            },
            "completion": self.completion,
            "alignment_truth_from_estimate": self.alignment.tolist(),
            "notes": self.notes,
        }


def evaluate(
    estimate: Trajectory,
    truth: Trajectory,
    *,
    max_dt_s: float = MAX_DT_S,
    input_stamps: Array | None = None,
) -> Evaluation:
    """Pairs by time, aligns rigidly (no scale), measures ATE and RPE.

    input_stamps: (F,) timestamps of the frames the estimate was made from. Completion is the share, of the
    frames that have a true pose within `max_dt_s`, that also have an estimated one. Raises InputError when
    fewer than 3 poses can be paired.
    """
    if not max_dt_s > 0:
        raise InputError(f"the largest time difference of a pair is {max_dt_s:g} s, must be positive")
    in_estimate, in_truth = associate(estimate.timestamps, truth.timestamps, max_dt_s)
    if len(in_estimate) < MIN_PAIRS:
        raise InputError(_too_few(estimate, truth, len(in_estimate), max_dt_s))
    poses, true_poses = estimate.poses[in_estimate], truth.poses[in_truth]
    alignment = umeyama(poses[:, :3, 3], true_poses[:, :3, 3])
    aligned = alignment @ poses
    errors = np.linalg.norm(aligned[:, :3, 3] - true_poses[:, :3, 3], axis=1)
    travelled = path_m(true_poses[:, :3, 3])
    stamps = truth.timestamps[in_truth]
    completion = None if input_stamps is None else completion_of(estimate, truth, input_stamps, max_dt_s)
    return Evaluation(
        pairs=len(in_estimate),
        path_m=float(travelled[-1]),
        duration_s=float(stamps[-1] - stamps[0]),
        ate=statistics(errors),
        rpe_per_metre=relative_error(poses, true_poses, travelled, 1.0),
        rpe_per_second=relative_error(poses, true_poses, stamps, 1.0),
        completion=completion,
        alignment=alignment,
        aligned=aligned,
        truth=true_poses,
        errors_m=errors,
        notes=[*estimate.notes, *truth.notes],
    )


def completion_of(
    estimate: Trajectory, truth: Trajectory, input_stamps: Array, max_dt_s: float
) -> float | None:
    """The share, of input frames with a true pose, that have an estimated one; None if none has a true one.

    An estimated pose stands for one frame only.
    """
    stamps = np.sort(input_stamps[np.isfinite(input_stamps)])
    if not len(stamps) or not len(truth):
        return None
    right = np.clip(np.searchsorted(truth.timestamps, stamps), 0, len(truth) - 1)
    left = np.clip(right - 1, 0, len(truth) - 1)
    gap = np.minimum(np.abs(truth.timestamps[left] - stamps), np.abs(truth.timestamps[right] - stamps))
    covered = gap <= max_dt_s
    if not covered.any():
        return None
    pairs = pair_by_time(stamps.tolist(), estimate.timestamps.tolist(), max_dt_s)
    tracked = sum(1 for i, _ in pairs if covered[i])
    return tracked / int(np.count_nonzero(covered))


def _too_few(estimate: Trajectory, truth: Trajectory, pairs: int, max_dt_s: float) -> str:
    if len(estimate) < MIN_PAIRS:
        return f"the trajectory has {len(estimate)} poses, at least {MIN_PAIRS} are needed to align it"
    if pairs:
        return f"only {pairs} poses lie within {max_dt_s:g} s of a true pose, at least {MIN_PAIRS} are needed"
    gap = smallest_gap(estimate.timestamps.tolist(), truth.timestamps.tolist())
    return (
        f"no pose lies within {max_dt_s:g} s of a true pose: the trajectory covers {_span(estimate)}, "
        f"the ground truth {_span(truth)}, the smallest gap is {gap:g} s"
    )


def _span(trajectory: Trajectory) -> str:
    return f"{trajectory.timestamps[0]:.3f} to {trajectory.timestamps[-1]:.3f} s"


def _relative_json(error: RelativeError | None) -> dict[str, float | int] | None:
    if error is None:
        return None
    return {
        "translation_rmse_m": error.translation.rmse,
        "translation_mean_m": error.translation.mean,
        "translation_median_m": error.translation.median,
        "translation_max_m": error.translation.max,
        "rotation_rmse_deg": error.rotation_deg.rmse,
        "rotation_mean_deg": error.rotation_deg.mean,
        "rotation_median_deg": error.rotation_deg.median,
        "rotation_max_deg": error.rotation_deg.max,
        "pairs": error.translation.count,
    }
