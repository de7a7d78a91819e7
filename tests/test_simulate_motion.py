"""Inertial and wheel measurements beside a sequence: integrated, they give the walk again."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_simulate import plan

from vsgraphs.compiled import core
from vsgraphs.plans import load_plan
from vsgraphs.simulate import Output, simulate
from vsgraphs.simulate.motion import GRAVITY, Errors, inertial, rotation_vectors, wheels

EXACT = Errors(*[0.0] * 9)  # rates keep their defaults


@pytest.fixture(scope="module")
def scene() -> Any:
    return core().build_scene(load_plan(plan()).plan)


def exponential(v: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    angle = np.linalg.norm(v)
    k = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    if angle < 1e-12:
        return np.eye(3) + k
    return np.eye(3) + np.sin(angle) / angle * k + (1 - np.cos(angle)) / angle**2 * k @ k


def test_integrated_readings_are_the_walk(scene: Any) -> None:
    duration = scene.duration_s
    times, readings = inertial(scene, duration, EXACT, 0)
    dt = times[1] - times[0]
    assert dt == pytest.approx(1 / 200)
    first = scene.poses([0.0, 1 / 200, -1 / 200])
    r, p = first[0, :3, :3], first[0, :3, 3]
    v = (first[1, :3, 3] - first[2, :3, 3]) * 100
    for a, b in itertools.pairwise(readings):
        mean = (a + b) / 2
        half = r @ exponential(mean[:3] * dt / 2)
        acceleration = half @ mean[3:] - (0, 0, GRAVITY)
        p = p + v * dt + acceleration * dt**2 / 2
        v = v + acceleration * dt
        r = r @ exponential(mean[:3] * dt)
    last = scene.poses([times[-1]])[0]
    assert np.linalg.norm(p - last[:3, 3]) < 0.02
    assert np.linalg.norm(rotation_vectors((r.T @ last[:3, :3])[None])) < 2e-3


def test_errors_have_the_stated_size(scene: Any) -> None:
    times, exact = inertial(scene, 5.0, EXACT, 0)
    noisy = inertial(scene, 5.0, Errors(), 3)[1]
    spread = np.diff(noisy - exact, axis=0).std(axis=0) / np.sqrt(2)
    assert spread[:3] == pytest.approx([1.7e-4 * np.sqrt(200)] * 3, rel=0.15)
    assert spread[3:] == pytest.approx([2e-3 * np.sqrt(200)] * 3, rel=0.15)
    assert len(times) == 1000
    assert (noisy == inertial(scene, 5.0, Errors(), 3)[1]).all()
    assert (noisy != inertial(scene, 5.0, Errors(), 4)[1]).any()


def test_wheels_count_the_way(scene: Any) -> None:
    exact = replace(EXACT, wheels_hz=50.0)
    times, places = wheels(scene, scene.duration_s, exact, 0)
    poses = scene.poses(times)
    start = np.arctan2(poses[0, 1, 2], poses[0, 0, 2])
    turn = np.array([[np.cos(start), -np.sin(start)], [np.sin(start), np.cos(start)]])
    assert np.allclose(places[:, :2] @ turn.T + poses[0, :2, 3], poses[:, :2, 3], atol=1e-6)
    drifted = wheels(scene, scene.duration_s, Errors(), 1)[1]
    way = np.linalg.norm(np.diff(poses[:, :2, 3], axis=0), axis=1).sum()
    assert 0 < np.linalg.norm(drifted[-1, :2] - places[-1, :2]) < 0.3 * way


def test_files_beside_the_frames(tmp_path: Path) -> None:
    simulate(plan(), tmp_path / "a", frames=6, output=Output(motion=True))
    imu = np.loadtxt(tmp_path / "a" / "imu.txt")
    assert imu.shape == (110, 7)  # to half a frame after the last one
    assert np.loadtxt(tmp_path / "a" / "odometry.txt").shape == (28, 4)
    assert np.linalg.norm(imu[:, 4:], axis=1).mean() == pytest.approx(GRAVITY, abs=0.5)
    first = np.loadtxt(tmp_path / "a" / "groundtruth.txt")[0, 0]
    assert imu[0, 0] == pytest.approx(first)
    assert "gyro_noise: 0.00017" in (tmp_path / "a" / "imu.yaml").read_text()
