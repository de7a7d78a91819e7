"""What is known at the end of a run, in the levelled frame of its scene graph."""

from __future__ import annotations

from typing import Any

from vsgraphs.run.naming import MarkerOutcome, named_graph
from vsgraphs.scene_graph import SceneGraph
from vsgraphs.trajectory import Trajectory


class Levelled:
    """Trajectory, keyframes, landmarks and scene graph of a finished Slam, all in one frame: z up, ground
    at 0; or the first camera's where there is no scene graph or the way up is not known.

    mode: the run's `system.mode`. trouble: what kept the scene graph from being made.
    positions: (M, 3) landmarks, m. colours: (M, 3) uint8.
    """

    def __init__(self, slam: Any, mode: str, markers: MarkerOutcome | None) -> None:
        snapshot = slam.snapshot()
        stamps, poses = slam.trajectory()
        ids, keyframe_stamps, keyframe_poses = snapshot.keyframes()
        self.trajectory = Trajectory(stamps, poses)
        self.keyframes = Trajectory(keyframe_stamps, keyframe_poses)
        self.positions, self.colours = snapshot.landmarks()
        self.graph: SceneGraph | None = None
        self.trouble: Exception | None = None
        if mode == "slam":
            return
        try:
            raw = snapshot.scene_graph()
            self.graph = named_graph(raw, (ids, keyframe_stamps, keyframe_poses), markers)
        except Exception as error:  # the trajectory is worth having without it, in the map's own frame
            self.trouble = error
            return
        self.trajectory.poses = self.graph.poses_from_map(poses)
        self.keyframes.poses = self.graph.poses_from_map(keyframe_poses)
        self.positions = self.graph.points_from_map(self.positions)
