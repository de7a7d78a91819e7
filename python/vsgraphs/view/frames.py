"""A frame in a viewer: camera, image, landmarks in it, classes over it, depth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vsgraphs.datasets import Calibration
from vsgraphs.export.class_colours import plane_of_points
from vsgraphs.lens import depth_metres
from vsgraphs.scene_graph import CLASS_COLOURS, NO_PLANE, ROLES, SceneGraph, transform_points
from vsgraphs.trajectory import Array
from vsgraphs.view.camera import back_project, landmarks_in_view, pixel_rays
from vsgraphs.view.extra import rerun
from vsgraphs.view.sinks import Sinks

STRIDE = 4  # of the pixels whose class is shown
DEPTH_STRIDE = 2
JPEG_QUALITY = 80
_CLASS_OPACITY = 0.35


@dataclass
class MapView:
    """What frames are shown against: the newest map, its landmarks in the map's frame, and the way up.

    graph: None where the map has no planes. owners: (M,) plane of each landmark, -1: none.
    """

    points: Array
    owners: npt.NDArray[np.int64]
    graph: SceneGraph | None
    up_from_map: Array


class FrameLogger:
    """Logs frames of one camera."""

    def __init__(self, sinks: Sinks, camera: Calibration) -> None:
        self._sinks = sinks
        self._camera = camera
        self._rays = pixel_rays(camera, STRIDE)
        self._log_cameras()

    def log(
        self,
        rgb: npt.NDArray[np.uint8],
        depth: npt.NDArray[np.generic],
        map_from_camera: Array | None,
        shown: MapView,
    ) -> None:
        """One frame; map_from_camera is its pose in the map, None while lost: the camera then stays."""
        rr = rerun()
        metres = depth_metres(depth, self._camera)
        self._sinks.log("world/camera/image", rr.Image(rgb).compress(jpeg_quality=JPEG_QUALITY))
        small = metres[::DEPTH_STRIDE, ::DEPTH_STRIDE]
        millimetres = np.minimum(small * 1000.0, 65535).astype(np.uint16)
        self._sinks.log(
            "world/camera/depth",
            rr.DepthImage(millimetres, meter=1000.0, depth_range=(0, 1000 * self._camera.depth_max_m)),
        )
        if map_from_camera is None:
            return
        pose = shown.up_from_map @ map_from_camera
        self._sinks.log("world/camera", rr.Transform3D(translation=pose[:3, 3], mat3x3=pose[:3, :3]))
        self._log_landmarks(metres, map_from_camera, shown)
        if shown.graph is not None:
            self._log_classes(metres, map_from_camera, shown.graph)

    def _log_cameras(self) -> None:
        rr = rerun()
        for name, stride in (("image", 1), ("depth", DEPTH_STRIDE)):
            c = self._camera
            self._sinks.log(
                f"world/camera/{name}",
                rr.Pinhole(
                    focal_length=(c.fx / stride, c.fy / stride),
                    principal_point=((c.cx + 0.5) / stride, (c.cy + 0.5) / stride),
                    resolution=(c.width // stride, c.height // stride),
                    image_plane_distance=0.6,
                    color=(235, 70, 60),
                ),
                static=True,
            )

    def _log_landmarks(self, metres: npt.NDArray[np.float32], map_from_camera: Array, shown: MapView) -> None:
        rr = rerun()
        pixels, index = landmarks_in_view(
            self._camera, metres, np.linalg.inv(map_from_camera).astype(np.float64), shown.points
        )
        colours = np.full((len(index), 3), NO_PLANE, np.uint8)
        if shown.graph is not None:
            owners = shown.owners[index]
            for plane in np.unique(owners[owners >= 0]):
                colours[owners == plane] = CLASS_COLOURS[shown.graph.planes[int(plane)].role]
        self._sinks.log(
            "world/camera/image/landmarks",
            rr.Points2D(pixels + 0.5, colors=colours, radii=rr.Radius.ui_points(2.0)),
        )

    def _log_classes(
        self, metres: npt.NDArray[np.float32], map_from_camera: Array, graph: SceneGraph
    ) -> None:
        rr = rerun()
        points, known = back_project(self._rays, metres, STRIDE)
        owners = plane_of_points(
            graph, transform_points(graph.frame.world_from_map @ map_from_camera, points)
        )
        numbers = {plane.id: ROLES.index(plane.role) + 1 for plane in graph.planes.values()}
        table = np.zeros(max(numbers, default=0) + 2, np.uint8)  # the last is for -1, no plane
        for plane, number in numbers.items():
            table[plane] = number
        classes = np.zeros(known.shape, np.uint8)
        classes[known] = table[owners]
        full = np.repeat(np.repeat(classes, STRIDE, axis=0), STRIDE, axis=1)
        shown = full[: self._camera.height, : self._camera.width]
        self._sinks.log(
            "world/camera/image/classes",
            rr.SegmentationImage(shown, opacity=_CLASS_OPACITY),
        )
