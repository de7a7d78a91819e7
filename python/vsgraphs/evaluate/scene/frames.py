"""From a scene graph's frame to the truth's, by the trajectory alone."""

from __future__ import annotations

import numpy as np

from vsgraphs.errors import InputError
from vsgraphs.evaluate.association import associate
from vsgraphs.scene_graph import SceneGraph
from vsgraphs.trajectory import Array, Trajectory

# What a camera's turn weighs against its place: the tips of arms this long count as places too. Against
# walks of metres it is nothing; after a straight walk it alone says which way is up.
ARM_M = 0.2
_SAME_STAMP_S = 1e-4
_AGREE_M = 0.05


def align_poses(estimate: Array, truth: Array) -> Array:
    """(N, 4, 4) paired poses -> (4, 4) rigid truth_from_estimate, no scale.

    Least squares over camera centres and the tips of arms along the camera's axes (Umeyama 1991 on these
    points): a walk along a straight line leaves the turn about it open, the cameras' own turn does not.
    """
    from vsgraphs.evaluate.alignment import umeyama

    return umeyama(_with_arms(estimate), _with_arms(truth))


def trajectory_from_graph(graph: SceneGraph, trajectory: Trajectory) -> Array:
    """(4, 4): the graph's frame -> the frame of `trajectory`, found by the graph's own keyframes.

    The identity where both are in one frame, as a run leaves them; where the trajectory is in the map's
    frame, the inverse of world_from_map. Raises InputError where neither fits: they are of different runs.
    """
    stamps = np.array([keyframe.timestamp_s for keyframe in graph.keyframes.values()])
    poses = np.array([keyframe.world_from_camera for keyframe in graph.keyframes.values()]).reshape(-1, 4, 4)
    order = np.argsort(stamps, kind="stable")
    ours, theirs = associate(stamps[order], trajectory.timestamps, _SAME_STAMP_S)
    if not len(ours):
        if len(stamps):
            raise InputError("no keyframe of the scene graph has a pose in the trajectory: different runs")
        return np.eye(4)
    keyframes, places = poses[order][ours], trajectory.positions[theirs]
    map_from_graph = np.asarray(np.linalg.inv(graph.frame.world_from_map), dtype=np.float64)
    for transform in (np.eye(4), map_from_graph):
        if np.median(np.linalg.norm((transform @ keyframes)[:, :3, 3] - places, axis=1)) < _AGREE_M:
            return transform
    raise InputError(
        "the scene graph's keyframes are not where the trajectory has them, in its frame or the map's: "
        "different runs"
    )


def _with_arms(poses: Array) -> Array:
    tips: Array = poses[:, None, :3, 3] + ARM_M * np.swapaxes(poses[:, :3, :3], 1, 2)
    arms: Array = np.concatenate([poses[:, None, :3, 3], tips], axis=1).reshape(-1, 3)
    return arms
