from __future__ import annotations

import numpy as np
import pytest

from vsgraphs.errors import InputError
from vsgraphs.evaluate import associate, completion_of, evaluate, umeyama
from vsgraphs.evaluate.errors import path_m, relative_error, rotation_angles
from vsgraphs.evaluate.plot import draw, horizontal_axes, up_axis
from vsgraphs.timestamps import pair_by_time, smallest_gap
from vsgraphs.trajectory import Trajectory, rotations_from_quaternions


def walk(count: int = 200, seed: int = 3, fps: float = 30.0) -> Trajectory:
    rng = np.random.default_rng(seed)
    poses = np.tile(np.eye(4), (count, 1, 1))
    turns = np.cumsum(rng.normal(0, 0.02, (count, 3)), axis=0)
    poses[:, :3, :3] = rotations_from_quaternions(np.concatenate([turns, np.ones((count, 1))], axis=1))
    poses[:, :3, 3] = np.cumsum(rng.normal(0, 0.03, (count, 3)), axis=0)
    return Trajectory(np.arange(count) / fps, poses)


def moved(trajectory: Trajectory, seed: int = 5) -> tuple[Trajectory, np.ndarray]:
    rng = np.random.default_rng(seed)
    transform = np.eye(4)
    transform[:3, :3] = rotations_from_quaternions(rng.normal(size=(1, 4)))[0]
    transform[:3, 3] = rng.normal(size=3) * 5
    return Trajectory(trajectory.timestamps, transform @ trajectory.poses), transform


def test_umeyama_finds_the_transform() -> None:
    points = np.random.default_rng(0).normal(size=(40, 3))
    _, transform = moved(walk())
    np.testing.assert_allclose(
        umeyama(points, points @ transform[:3, :3].T + transform[:3, 3]), transform, atol=1e-12
    )


def test_umeyama_never_mirrors() -> None:
    points = np.random.default_rng(0).normal(size=(40, 3))
    assert np.linalg.det(umeyama(points, points * [1, 1, -1])[:3, :3]) == pytest.approx(1.0)
    flat = points * [1, 1, 0]
    assert np.linalg.det(umeyama(flat, flat)[:3, :3]) == pytest.approx(1.0)


def test_a_moved_trajectory_has_no_error() -> None:
    truth = walk()
    estimate, transform = moved(truth)
    result = evaluate(estimate, truth, input_stamps=truth.timestamps)
    assert result.ate.max < 1e-12
    assert result.completion == 1.0
    assert result.rpe_per_metre is not None
    assert result.rpe_per_metre.translation.max < 1e-9
    assert result.rpe_per_metre.rotation_deg.max < 1e-6
    np.testing.assert_allclose(result.alignment, np.linalg.inv(transform), atol=1e-9)


def test_a_wrong_scale_is_an_error() -> None:
    truth = walk()
    estimate, _ = moved(truth)
    estimate.poses[:, :3, 3] *= 1.1
    spread = np.sqrt(((truth.positions - truth.positions.mean(axis=0)) ** 2).sum(axis=1).mean())
    assert evaluate(estimate, truth).ate.rmse == pytest.approx(0.1 * spread, rel=1e-6)


def test_ate_of_known_offsets() -> None:
    truth = walk(4)
    truth.poses[:, :3, 3] = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]]
    estimate = Trajectory(truth.timestamps, truth.poses.copy())
    estimate.poses[:, 2, 3] = [0.1, -0.1, 0.1, -0.1]  # a twist no rigid motion removes
    ate = evaluate(estimate, truth).ate
    assert (ate.rmse, ate.mean, ate.median, ate.max) == pytest.approx((0.1,) * 4)


def test_rpe_of_a_steady_drift() -> None:
    count = 101
    truth = Trajectory(np.arange(count) / 10, np.tile(np.eye(4), (count, 1, 1)))
    truth.poses[:, 0, 3] = np.arange(count) * 0.05
    estimate = Trajectory(truth.timestamps, truth.poses.copy())
    estimate.poses[:, 0, 3] *= 1.02
    result = evaluate(estimate, truth)
    assert result.rpe_per_metre is not None
    assert result.rpe_per_second is not None
    assert result.rpe_per_metre.translation.rmse == pytest.approx(0.02)
    assert result.rpe_per_metre.translation.count == 81  # 1 m is 20 steps, each to the tick
    assert result.rpe_per_second.translation.max == pytest.approx(0.02 * 0.5)
    assert result.rpe_per_second.translation.count == 91


def test_rpe_of_a_steady_turn() -> None:
    count = 31
    truth = np.tile(np.eye(4), (count, 1, 1))
    estimate = truth.copy()
    angles = np.radians(np.arange(count) * 0.3)
    estimate[:, :3, :3] = [[[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]] for a in angles]
    error = relative_error(estimate, truth, np.arange(count) / 10, 1.0)
    assert error is not None
    assert error.rotation_deg.rmse == pytest.approx(3.0)
    assert relative_error(estimate, truth, np.arange(count) / 100, 1.0) is None


def test_angles_from_nothing_to_half_a_turn() -> None:
    angles = np.array([0.0, 1e-9, 1e-4, 1.0, 3.0, np.pi - 1e-9, np.pi])
    rotations = np.array([[[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]] for a in angles])
    np.testing.assert_allclose(rotation_angles(rotations), angles, atol=1e-12)


def test_path() -> None:
    np.testing.assert_allclose(path_m(np.array([[0, 0, 0], [3, 4, 0], [3, 4, 2.0]])), [0, 5, 7])


def test_association_goes_from_the_shorter_list() -> None:
    few, many = np.array([0.0, 1.0, 2.0]), np.array([0.004, 0.012, 0.998, 1.5, 2.02])
    for first, second in ((few, many), (many, few)):
        i, j = associate(first, second, 0.01)
        pairs = list(zip(i.tolist(), j.tolist(), strict=True))
        assert pairs == ([(0, 0), (1, 2)] if first is few else [(0, 0), (2, 1)])
    assert len(associate(few, np.zeros(0))[0]) == 0


def test_pairs_are_one_to_one_and_nearest_first() -> None:
    assert pair_by_time([0.0, 0.01], [0.009], 0.02) == [(1, 0)]
    assert pair_by_time([0.0, 0.01, 0.02], [0.001, 0.019], 0.02) == [(0, 0), (2, 1)]
    assert pair_by_time([], [1.0], 0.1) == []
    assert smallest_gap([0.0, 5.0], [1.5, 7.0, 9.0]) == 1.5


def test_completion() -> None:
    truth = walk(100)
    estimate = Trajectory(truth.timestamps[20:90], truth.poses[20:90])
    assert completion_of(estimate, truth, truth.timestamps, 0.01) == pytest.approx(0.7)
    # Frames without a true pose say nothing: here 50 of them before the truth begins.
    early = np.concatenate([truth.timestamps[0] - np.arange(50, 0, -1) / 30, truth.timestamps])
    assert completion_of(estimate, truth, early, 0.01) == pytest.approx(0.7)
    assert completion_of(estimate, truth, truth.timestamps + 1000, 0.01) is None
    # A tolerance wider than the frames are apart must not count a neighbour's pose for a missing one.
    assert completion_of(estimate, truth, truth.timestamps, 0.05) == pytest.approx(0.7)


def test_too_little_to_compare() -> None:
    truth = walk()
    short = Trajectory(truth.timestamps[:2], truth.poses[:2])
    with pytest.raises(InputError, match="the trajectory has 2 poses, at least 3"):
        evaluate(short, truth)
    late = Trajectory(truth.timestamps + 3600, truth.poses)
    with pytest.raises(
        InputError, match=r"no pose lies within 0\.01 s .* covers 3600\.000 to 3606.* gap is 3593"
    ):
        evaluate(late, truth)
    stamps = truth.timestamps + np.where(np.arange(200) < 2, 0, 100)
    with pytest.raises(InputError, match="only 2 poses lie within"):
        evaluate(Trajectory(stamps, truth.poses), truth)
    with pytest.raises(InputError, match="must be positive"):
        evaluate(truth, truth, max_dt_s=0)


def test_picture_has_both_views_and_is_the_same_twice() -> None:
    truth = walk()
    estimate, _ = moved(truth)
    estimate.poses[:, :3, 3] += np.random.default_rng(0).normal(0, 0.02, (200, 3))
    result = evaluate(estimate, truth)
    svg = draw(result, "svg")
    assert svg == draw(result, "svg")
    assert svg.startswith(b"<?xml")
    assert draw(result, "png").startswith(b"\x89PNG")


def test_up_is_what_cameras_call_up() -> None:
    level = np.array(
        [[1, 0, 0], [0, 0, 1], [0, -1, 0]], float
    )  # a camera that looks along y in a world with z up
    poses = np.tile(np.eye(4), (5, 1, 1))
    assert up_axis(poses) == (1, -1.0)  # a world that is the first camera: y down
    poses[:, :3, :3] = level
    assert up_axis(poses) == (2, 1.0)
    positions = np.array([[0, 0, 0], [1, 3, 9.0]])
    assert horizontal_axes(positions, 2) == (1, 0)
