"""Markers in drawn images: where they are, how exactly, and what is left out."""

from __future__ import annotations

import subprocess
import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from vsgraphs.markers import MarkerDetector, MarkerRegistry
from vsgraphs.markers.poses import decide
from vsgraphs.markers.square import DepthReadings, corners_of, covariance_of, refine
from vsgraphs.trajectory import Array

cv2 = pytest.importorskip("cv2")

SIZE_M = 0.16
WIDTH, HEIGHT, FOCAL = 640, 480, 525.0


def camera(distortion: tuple[float, ...] = (0, 0, 0, 0, 0)) -> Any:
    return SimpleNamespace(
        width=WIDTH,
        height=HEIGHT,
        fx=FOCAL,
        fy=FOCAL,
        cx=319.5,
        cy=239.5,
        distortion=list(distortion),
        depth_scale=5000.0,
        depth_min_m=0.3,
        depth_max_m=8.0,
        invalid_depth=[0, 65535],
        depth_noise=(0.0012, 0.0019, 0.4),
        depth_alignment_m=0.01,
    )


def detector(seen_by: Any | None = None, size_m: float = SIZE_M) -> MarkerDetector:
    return MarkerDetector(MarkerRegistry("4x4_50", size_m), seen_by or camera())


def pose_of(x: float, y: float, z: float, yaw_deg: float = 0, pitch_deg: float = 0) -> Array:
    """Facing the camera, turned about the marker's y and x."""
    facing = np.diag([1.0, -1.0, -1.0])
    turn = cv2.Rodrigues(np.deg2rad([0, yaw_deg, 0]))[0] @ cv2.Rodrigues(np.deg2rad([pitch_deg, 0, 0]))[0]
    pose = np.eye(4)
    pose[:3, :3] = facing @ turn
    pose[:3, 3] = x, y, z
    return pose


def draw(markers: dict[int, Array], seen_by: Any | None = None) -> tuple[Array, Array]:
    """(grey uint8, depth float32 metres): sheets that float before nothing, oversampled."""
    seen_by = seen_by or camera()
    fine = 2
    v, u = np.mgrid[0 : HEIGHT * fine, 0 : WIDTH * fine]
    at = np.stack([(u - (fine - 1) / 2) / fine, (v - (fine - 1) / 2) / fine], axis=-1).reshape(-1, 1, 2)
    matrix = np.array([[FOCAL, 0, seen_by.cx], [0, FOCAL, seen_by.cy], [0, 0, 1]])
    lens = np.array(seen_by.distortion, dtype=np.float64)
    rays = cv2.undistortPoints(at.astype(np.float64), matrix, lens).reshape(-1, 2) if lens.any() else None
    if rays is None:
        rays = (at.reshape(-1, 2) - [seen_by.cx, seen_by.cy]) / FOCAL
    rays = np.column_stack([rays, np.ones(len(rays))])
    grey, depth = np.full(len(rays), 120.0), np.full(len(rays), np.nan)
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    for number, pose in markers.items():
        cells = np.pad(cv2.aruco.generateImageMarker(dictionary, number, 6), 1, constant_values=255)
        normal = pose[:3, 2]
        along = float(normal @ pose[:3, 3]) / (rays @ normal)
        on_sheet = (rays * along[:, None] - pose[:3, 3]) @ pose[:3, :3]
        column = np.floor((on_sheet[:, 0] / SIZE_M + 0.5) * 6 + 1).astype(int)
        row = np.floor((0.5 - on_sheet[:, 1] / SIZE_M) * 6 + 1).astype(int)
        hit = (column >= 0) & (column < 8) & (row >= 0) & (row < 8) & (along > 0)
        grey[hit], depth[hit] = cells[row[hit], column[hit]] * 0.7 + 40, along[hit]
    image = grey.reshape(HEIGHT, fine, WIDTH, fine).mean(axis=(1, 3))
    middle = depth.reshape(HEIGHT, fine, WIDTH, fine)[:, fine // 2, :, fine // 2]
    return np.rint(image).astype(np.uint8), middle.astype(np.float32)


def raw(metres: Array) -> Array:
    return np.nan_to_num(metres * 5000).astype(np.uint16)


def error(estimated: Array, true: Array) -> tuple[float, float]:
    """(m, deg)"""
    off = np.linalg.inv(true) @ estimated
    turned = float(np.linalg.norm(cv2.Rodrigues(off[:3, :3])[0]))
    return float(np.linalg.norm(off[:3, 3])), float(np.rad2deg(turned))


@pytest.mark.parametrize(("z", "yaw"), [(0.8, 0), (0.8, 35), (1.5, -30), (2.0, 40)])
def test_poses_are_true_and_covariances_cover_them(z: float, yaw: float) -> None:
    truth = pose_of(0.2, -0.1, z, yaw, 10)
    grey, metres = draw({7: truth})
    found = detector()(grey, raw(metres))
    assert found.ids.tolist() == [7]
    assert found.size_m.tolist() == [SIZE_M]
    metres_off, degrees_off = error(found.camera_from_marker[0], truth)
    assert metres_off < 0.012 * z**2
    assert degrees_off < 3 * z
    sigmas = np.sqrt(np.diag(found.covariance[0]))
    assert metres_off < 3 * np.linalg.norm(sigmas[:3])
    assert np.deg2rad(degrees_off) < 3 * np.linalg.norm(sigmas[3:])


def test_colour_images_and_metric_depth_are_taken_too() -> None:
    grey, metres = draw({7: pose_of(0, 0, 1, 20)})
    plain = detector()(grey, raw(metres))
    colour = detector()(np.repeat(grey[:, :, None], 3, axis=2), metres)
    np.testing.assert_allclose(colour.camera_from_marker, plain.camera_from_marker, atol=1e-3)


def test_several_in_order_of_their_numbers() -> None:
    grey, metres = draw(
        {20: pose_of(-0.3, 0, 1.2, 20), 3: pose_of(0.3, 0, 1.2, -20), 7: pose_of(0, 0.2, 1.1)}
    )
    found = detector()(grey, raw(metres))
    assert found.ids.tolist() == [3, 7, 20]
    again = detector()(grey, raw(metres))
    assert found.camera_from_marker.tobytes() == again.camera_from_marker.tobytes()


def test_nothing_is_an_answer() -> None:
    found = detector()(np.full((HEIGHT, WIDTH), 120, np.uint8), np.zeros((HEIGHT, WIDTH), np.uint16))
    assert found.ids.shape == (0,)
    assert found.camera_from_marker.shape == (0, 4, 4)
    assert found.covariance.shape == (0, 6, 6)


def test_a_lens_that_distorts() -> None:
    lens = camera((0.2, -0.3, 0.001, -0.002, 0.05))
    truth = pose_of(0.45, 0.3, 1.2, 25)
    grey, metres = draw({7: truth}, lens)
    metres_off, degrees_off = error(detector(lens)(grey, raw(metres)).camera_from_marker[0], truth)
    assert metres_off < 0.015
    assert degrees_off < 3
    straight = error(detector()(grey, raw(metres)).camera_from_marker[0], truth)
    assert straight[0] > metres_off


def test_depth_decides_between_the_two_solutions() -> None:
    """Far away, corners alone leave both open: without depth the marker is left out, with it, right."""
    right, undecided = 0, 0
    for yaw in (-35, -25, 25, 35):
        truth = pose_of(0.1, 0, 2.8, yaw)
        grey, metres = draw({7: truth})
        blind = detector()(grey, np.zeros((HEIGHT, WIDTH), np.uint16))
        undecided += blind.unsure == [7]
        seeing = detector()(grey, raw(metres))
        assert seeing.ids.tolist() == [7], yaw
        right += error(seeing.camera_from_marker[0], truth)[1] < 15
    assert right == 4
    assert undecided >= 2


def test_a_print_of_another_size_is_left_out_and_its_size_told() -> None:
    grey, metres = draw({7: pose_of(0, 0, 1, 20)})
    found = detector(size_m=0.10)(grey, raw(metres))
    assert found.ids.tolist() == []
    ((number, scale),) = found.scales
    assert number == 7
    assert scale == pytest.approx(1.6, abs=0.05)


def test_tiny_markers_are_not_believed() -> None:
    grey, metres = draw({7: pose_of(0, 0, 8)})
    found = detector()(grey, raw(metres))
    assert found.ids.tolist() == []
    assert found.unsure == []


def test_the_covariance_is_that_of_noisy_corners() -> None:
    truth, sigma_px = pose_of(0.2, 0.1, 1.0, 30, -15), 0.2
    square, matrix = corners_of(SIZE_M), np.array([[FOCAL, 0, 319.5], [0, FOCAL, 239.5], [0, 0, 1]])
    turn, shift = cv2.Rodrigues(truth[:3, :3])[0], truth[:3, 3].reshape(3, 1).copy()
    exact = cv2.projectPoints(square, turn, shift, matrix, None)[0].reshape(4, 2)
    random = np.random.default_rng(1)
    moves = []
    for _ in range(400):
        corners = exact + sigma_px * random.standard_normal((4, 2))
        off = np.linalg.inv(truth) @ refine(truth, corners, SIZE_M, camera())
        moves.append(np.concatenate([off[:3, 3], cv2.Rodrigues(off[:3, :3])[0].ravel()]))
    predicted = np.sqrt(np.diag(covariance_of(truth, SIZE_M, camera(), sigma_px)))
    np.testing.assert_allclose(np.std(moves, axis=0), predicted, rtol=0.15)


def noisy_corners_and_depth(truth: Array, random: Any) -> tuple[Array, Array]:
    """(4, 2) pixels and (h, w) metres of the marker's plane, as uncertain as `camera()` says they are."""
    seen_by, points = camera(), corners_of(SIZE_M) @ truth[:3, :3].T + truth[:3, 3]
    corners = points[:, :2] / points[:, 2:] * FOCAL + [seen_by.cx, seen_by.cy]
    v, u = np.mgrid[0:HEIGHT, 0:WIDTH]
    slant = (
        np.stack([(u - seen_by.cx) / FOCAL, (v - seen_by.cy) / FOCAL, np.ones(u.shape)], -1) @ truth[:3, 2]
    )
    depth = (truth[:3, 2] @ truth[:3, 3]) / slant
    offset, scale, onset = seen_by.depth_noise
    # As noisy as few independent readings; and what they all have in common.
    noise = (offset + scale * (depth - onset) ** 2) * random.standard_normal(depth.shape)
    common = seen_by.depth_alignment_m * random.standard_normal()
    return corners + 0.5 * random.standard_normal((4, 2)), (depth + noise + common).astype(np.float32)


def test_depth_says_how_far_away_a_marker_is() -> None:
    """Half a pixel in a side of 28 is 5 cm in 3 m; its depth is known to 2 cm."""
    truth = pose_of(0.2, 0.1, 3.0, 30, -10)
    random = np.random.default_rng(2)
    by_corners, by_both, predicted = [], [], []
    for _ in range(100):
        corners, metres = noisy_corners_and_depth(truth, random)
        by_corners.append(refine(truth, corners, SIZE_M, camera())[2, 3] - truth[2, 3])
        found = decide([truth], corners, SIZE_M, metres, camera())
        assert found is not None
        by_both.append(found.camera_from_marker[2, 3] - truth[2, 3])
        rotation = found.camera_from_marker[:3, :3]
        predicted.append(np.sqrt((rotation @ found.covariance[:3, :3] @ rotation.T)[2, 2]))
    assert np.std(by_corners) > 0.04
    assert np.std(by_both) < 0.015
    assert abs(np.mean(by_both)) < 0.01
    assert np.std(by_both) < np.mean(predicted) < 2 * np.std(by_both)


def test_the_derivatives_of_readings_are_those_of_their_residuals() -> None:
    pose = pose_of(0.2, 0.1, 1.5, 30, -10)
    _, metres = noisy_corners_and_depth(pose, np.random.default_rng(3))
    readings = DepthReadings.at(pose, SIZE_M, metres, camera())
    assert readings is not None
    at_rest, jacobian = readings.rows(pose)
    for axis in range(6):
        move = np.zeros(6)
        move[axis] = 1e-6
        moved = pose.copy()
        moved[:3, :3] = pose[:3, :3] @ cv2.Rodrigues(move[3:])[0]
        moved[:3, 3] += pose[:3, :3] @ move[:3]
        numeric = (readings.rows(moved)[0] - at_rest) / 1e-6
        np.testing.assert_allclose(jacobian[:, axis], numeric, atol=1e-3 * np.abs(jacobian).max())


def test_a_reading_of_the_wall_behind_is_left_out() -> None:
    truth = pose_of(0.2, 0.1, 1.5, 30, -10)
    corners, metres = noisy_corners_and_depth(truth, np.random.default_rng(4))
    metres[:, : int(319.5 + FOCAL * 0.2 / 1.5) - 12] += 0.8  # a strip of the print
    found = decide([truth], corners, SIZE_M, metres, camera())
    assert found is not None
    assert error(found.camera_from_marker, truth)[0] < 0.02


def test_without_opencv_the_extra_is_named() -> None:
    program = (
        "import sys; sys.modules['cv2'] = None\n"
        "from types import SimpleNamespace\n"
        "from vsgraphs.markers import MarkerDetector, MarkerRegistry\n"
        "MarkerDetector(MarkerRegistry('4x4_50', 0.16), SimpleNamespace())\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert "--markers needs OpenCV; install it with: pip install 'vsgraphs[markers]'" in done.stderr
