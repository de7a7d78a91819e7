"""Finds ArUco markers in an image, and where they are by their corners and the depth image.

Detection is OpenCV's (Garrido-Jurado et al., "Automatic generation and detection of highly reliable fiducial
markers under occlusion", Pattern Recognition 2014); for the poses see `poses`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vsgraphs.errors import InputError
from vsgraphs.lens import depth_metres, undistort
from vsgraphs.markers.poses import SMALLEST_SIDE_PX, SquarePose, decide, two_poses
from vsgraphs.markers.registry import MarkerRegistry
from vsgraphs.markers.square import Metres
from vsgraphs.trajectory import Array


@dataclass(frozen=True)
class Detections:
    """N markers: ids (N,) int64, size_m (N,), camera_from_marker (N, 4, 4), covariance (N, 6, 6), as
    `Slam.add_markers` takes them. unsure: numbers seen whose pose was not; scales: (number, how many times
    larger depth says the print is than the file does) of those left out for it.
    """

    ids: np.ndarray[Any, np.dtype[np.int64]]
    size_m: Array
    camera_from_marker: Array
    covariance: Array
    unsure: list[int]
    scales: list[tuple[int, float]]


class MarkerDetector:
    """Call it with an image and its depth. Raises InputError where OpenCV is not installed.

    camera: a `vsgraphs.Camera`. Cost: 3 to 10 ms for 640x480 pixels. Equal images give equal results.
    """

    def __init__(self, registry: MarkerRegistry, camera: Any) -> None:
        self._cv2 = _opencv()
        self._registry, self._camera = registry, camera
        aruco = self._cv2.aruco
        parameters = aruco.DetectorParameters()
        parameters.cornerRefinementMethod = aruco.CORNER_REFINE_SUBPIX
        dictionary = getattr(aruco, f"DICT_{registry.dictionary.upper()}")
        self._detector = aruco.ArucoDetector(aruco.getPredefinedDictionary(dictionary), parameters)

    def __call__(self, rgb: Array, depth: Array) -> Detections:
        """rgb: (h, w, 3) or (h, w) uint8; depth: (h, w) uint16 raw or float32 metres, of the same size."""
        grey = rgb if rgb.ndim == 2 else self._cv2.cvtColor(rgb, self._cv2.COLOR_RGB2GRAY)
        found, numbers, _ = self._detector.detectMarkers(np.ascontiguousarray(grey))
        numbers = [] if numbers is None else [int(n) for n in np.asarray(numbers).ravel()]
        metres = self._metres(depth)
        rows: list[tuple[int, SquarePose]] = []
        unsure: list[int] = []
        scales: list[tuple[int, float]] = []
        # By number, then by place: the order OpenCV finds them in is its own business.
        corners = [np.asarray(c, dtype=np.float64).reshape(4, 2) for c in found]
        for i in sorted(range(len(numbers)), key=lambda i: (numbers[i], *corners[i][0])):
            sides = np.linalg.norm(np.roll(corners[i], -1, axis=0) - corners[i], axis=1)
            if sides.min() < SMALLEST_SIDE_PX:
                continue
            size_m = self._registry.size_of(numbers[i])
            pose = self._pose(corners[i], size_m, metres)
            if pose is None:
                unsure.append(numbers[i])
            elif pose.wrong_scale is not None:
                scales.append((numbers[i], pose.wrong_scale))
            else:
                rows.append((numbers[i], pose))
        return Detections(
            ids=np.array([number for number, _ in rows], dtype=np.int64),
            size_m=np.array([self._registry.size_of(number) for number, _ in rows], dtype=np.float64),
            camera_from_marker=np.array([p.camera_from_marker for _, p in rows], dtype=np.float64).reshape(
                -1, 4, 4
            ),
            covariance=np.array([p.covariance for _, p in rows], dtype=np.float64).reshape(-1, 6, 6),
            unsure=unsure,
            scales=scales,
        )

    def _pose(self, corners: Array, size_m: float, metres: Metres) -> SquarePose | None:
        ideal = self._ideal(corners)
        try:
            return decide(two_poses(ideal, size_m, self._camera), ideal, size_m, metres, self._camera)
        except np.linalg.LinAlgError:  # corners on one line
            return None

    def _ideal(self, corners: Array) -> Array:
        """(4, 2) pixels as a lens without distortion would show them."""
        camera = self._camera
        x, y = undistort(camera, corners[:, 0], corners[:, 1])
        return np.column_stack([camera.fx * x + camera.cx, camera.fy * y + camera.cy])

    def _metres(self, depth: Array) -> Metres:
        """NaN where there is no reading."""
        metres = depth_metres(depth, self._camera)
        metres[~((metres >= self._camera.depth_min_m) & (metres <= self._camera.depth_max_m))] = np.nan
        return metres


def _opencv() -> Any:
    try:
        import cv2
    except ImportError:
        raise InputError("--markers needs OpenCV; install it with: pip install 'vsgraphs[markers]'") from None
    if not hasattr(cv2, "aruco") or not hasattr(cv2.aruco, "ArucoDetector"):
        raise InputError(
            f"OpenCV {cv2.__version__} has no cv2.aruco.ArucoDetector; "
            "install a newer one with: pip install 'vsgraphs[markers]'"
        )
    return cv2
