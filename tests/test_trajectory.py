from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from vsgraphs.errors import InputError
from vsgraphs.trajectory import (
    format_tum,
    quaternions_from_rotations,
    read_tum_trajectory,
    rotations_from_quaternions,
)


def some_poses(count: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, :3, :3] = rotations_from_quaternions(rng.normal(size=(count, 4)))
    poses[:, :3, 3] = rng.normal(size=(count, 3)) * 10
    return poses


def test_quaternions_there_and_back() -> None:
    half_turns = np.array(
        [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1], [1, 1, 0, 0], [1e-9, 0, 0, 1]]
    )
    q = np.concatenate([np.random.default_rng(1).normal(size=(500, 4)), half_turns])
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    rotations = rotations_from_quaternions(q)
    np.testing.assert_allclose(
        rotations @ np.swapaxes(rotations, 1, 2), np.tile(np.eye(3), (506, 1, 1)), atol=1e-12
    )
    np.testing.assert_allclose(np.linalg.det(rotations), 1.0)
    back = quaternions_from_rotations(rotations)
    np.testing.assert_allclose(np.abs((back * q).sum(axis=1)), 1.0, atol=1e-12)
    assert (back[:, 3] >= 0).all()


def test_quarter_turn_about_z() -> None:
    s = np.sqrt(0.5)
    rotation = rotations_from_quaternions(np.array([[0, 0, s, s]]))[0]
    np.testing.assert_allclose(rotation, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-12)


def test_write_and_read(tmp_path: Path) -> None:
    stamps, poses = 1305031102.175304 + np.arange(50) / 30, some_poses(50)
    path = tmp_path / "trajectory.txt"
    path.write_text(format_tum(stamps, poses))
    back = read_tum_trajectory(path)
    np.testing.assert_allclose(back.timestamps, stamps, atol=6e-7)
    np.testing.assert_allclose(back.poses, poses, atol=1e-7)
    assert back.notes == []
    assert path.read_text().splitlines()[1].split()[0] == "1305031102.175304"


def test_text_is_of_fixed_precision_without_minus_zero() -> None:
    pose = np.eye(4)
    pose[:3, 3] = [-1e-9, 1 / 3, -2]
    assert format_tum([0.5], pose[None]).splitlines()[1] == (
        "0.500000 0.0000000 0.3333333 -2.0000000 0.000000000 0.000000000 0.000000000 1.000000000"
    )
    assert format_tum([], np.zeros((0, 4, 4))).count("\n") == 1


def read(tmp_path: Path, text: str):  # type: ignore[no-untyped-def]
    path = tmp_path / "truth.txt"
    path.write_text(text)
    return read_tum_trajectory(path)


def test_repairs_are_told(tmp_path: Path) -> None:
    lines = [
        "3 3 0 0 0 0 0 1",
        "1 1 0 0 0 0 0 1",
        "nan 9 0 0 0 0 0 1",
        "2 nan 0 0 0 0 0 1",
        "4 4 0 0 0 0 0 0",
    ]
    trajectory = read(tmp_path, "\n".join([*lines, "1 8 0 0 0 0 0 2", "", "# end", "5,5,0,0,0,0,0,1"]))
    np.testing.assert_array_equal(trajectory.timestamps, [1, 3, 5])
    np.testing.assert_array_equal(trajectory.positions[:, 0], [1, 3, 5])
    told = " ".join(trajectory.notes)
    assert "3 of 7 poses are not finite" in told
    assert "not in order of time, sorted" in told
    assert "1 repeated timestamps" in told


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "holds no pose"),
        ("# nothing\n", "holds no pose"),
        ("1 2 3\n", r"truth\.txt:1: 3 numbers where a TUM pose .* has 8"),
        ("1 0 0 0 0 0 0 1\n2 0 0 zero 0 0 0 1\n", r"truth\.txt:2: not a number"),
        ("nan 0 0 0 0 0 0 1\n", "holds no finite pose"),
    ],
)
def test_mistakes(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read(tmp_path, text)


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read .*No such file"):
        read_tum_trajectory(tmp_path / "none.txt")
