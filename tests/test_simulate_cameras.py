"""Sensors by name, effects of the camera, and what befalls the frames on their way to the disk."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Program, one_line_error
from PIL import Image
from test_simulate import PLAN_DICT, plan, stamps

from vsgraphs.datasets import open_sequence
from vsgraphs.errors import InputError
from vsgraphs.simulate import Output, effect_names, simulate
from vsgraphs.simulate.stream import Stream, schedule


def without_camera() -> dict[str, Any]:
    return {key: value for key, value in PLAN_DICT.items() if key != "camera"}


@pytest.mark.parametrize(
    ("sensor", "size"), [("kinect1", (640, 480)), ("kinect2", (512, 424)), ("iphone_lidar", (640, 480))]
)
def test_a_sensor_brings_its_image_and_its_range(tmp_path: Path, sensor: str, size: tuple[int, int]) -> None:
    simulate(without_camera(), tmp_path / "a", sensor=sensor, frames=1)
    assert Image.open(next((tmp_path / "a" / "rgb").iterdir())).size == size
    depth = np.asarray(Image.open(next((tmp_path / "a" / "depth").iterdir()))) / 5000
    assert (depth.max() <= 5) == (sensor != "kinect1") or depth.max() < 5
    assert json.loads((tmp_path / "a" / "scene_gt.json").read_text())["sensor"] == sensor
    assert len(open_sequence(tmp_path / "a").frames) == 1


def test_plans_name_their_camera_and_commands_change_it(tmp_path: Path, vsgraphs: Program) -> None:
    file = tmp_path / "plan.json"
    file.write_text(json.dumps(plan(sensor="kinect1", effects={"comment": "x", "roll_deg": 180})))
    options = ["--frames", 1, "--labels-every", 1]
    done = vsgraphs("simulate", file, "--out", tmp_path / "a", *options, "--effect", "lens=radial_tangential",
                    "--effect", "lens_k=-0.1,0.02")  # fmt: skip
    assert done.returncode == 0, done.stderr
    truth = json.loads((tmp_path / "a" / "scene_gt.json").read_text())
    assert truth["sensor"] == "kinect1"
    assert truth["effects"] == {"roll_deg": 180, "lens": "radial_tangential", "lens_k": [-0.1, 0.02]}
    assert "distortion: [-0.1, 0.02, 0.0, 0.0, 0.0]" in (tmp_path / "a" / "camera.yaml").read_text()
    assert open_sequence(tmp_path / "a").camera.distortion[:2] == [-0.1, 0.02]
    done = vsgraphs("simulate", file, "--out", tmp_path / "b", *options, "--sensor", "clean")
    assert done.returncode == 0, done.stderr
    assert "sensor" not in json.loads((tmp_path / "b" / "scene_gt.json").read_text())


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--sensor", "kinect"], "sensor: must be one of classic, clean, kinect1"),
        (["--effect", "roling_shutter_s=1"], "did you mean 'rolling_shutter_s'?"),
        (["--effect", "rolling_shutter_s"], "give KEY=VALUE"),
        (["--effect", "rolling_shutter_s=fast"], "is no number"),
        (["--effect", "rolling_shutter_s=7"], "noise.rolling_shutter_s: must lie in"),
        (["--effect", "lens=barrel"], "lens: must be one of none, radial_tangential"),
        (["--effect", "drop_share=2"], "drop_share must lie in 0..0.95"),
        (["--effect", "fov_deg=179"], "fov_deg must lie in"),
        (["--effect", "motion_blur=2"], "noise.motion_blur cannot be"),
        (["--noise", "clean", "--sensor", "d435"], "leave --sensor d435 away"),
    ],
)
def test_mistakes_are_one_line(tmp_path: Path, vsgraphs: Program, options: list[str], message: str) -> None:
    done = vsgraphs("simulate", "demo", "--out", tmp_path / "x", "--frames", 1, *options)
    assert message in one_line_error(done)
    assert list(tmp_path.iterdir()) == []


def test_wrong_effects_of_a_plan_are_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="effects: expected an object"):
        simulate(plan(effects=[1]), tmp_path / "x")
    with pytest.raises(InputError, match="unknown effect 'blur'"):
        simulate(plan(effects={"blur": 1}), tmp_path / "x")


def test_frames_that_are_lost_doubled_and_frozen() -> None:
    clean = schedule(range(200), 10, Stream(), 0)
    assert [shot.index for shot in clean] == list(range(200))
    assert all(shot.source == shot.index and shot.rgb_stamp == shot.truth_stamp for shot in clean)
    lost = schedule(range(400), 10, Stream(drop_share=0.2), 1)
    assert 290 < len(lost) < 350
    doubled = schedule(range(400), 10, Stream(double_share=0.1), 1)
    again = [b for a, b in itertools.pairwise(doubled) if b.source == a.source]
    assert 20 < len(again) < 65
    frozen = schedule(range(100), 10, Stream(freeze_every_s=4, freeze_s=1), 1)
    assert [s.source for s in frozen[38:52]] == [38, *[39] * 11, 50, 51]


def test_stamps_jitter_about_the_true_time_and_clocks_jump() -> None:
    shots = schedule(range(300), 30, Stream(stamp_jitter_s=0.004), 2)
    for stamp in ("rgb_stamp", "depth_stamp"):
        errors = np.array([float(getattr(s, stamp)) - float(s.truth_stamp) for s in shots])
        assert 0.003 < errors.std() < 0.005
        assert np.abs(errors).max() <= 0.0101
    behind = schedule(range(100), 10, Stream(clock_jump_at_s=5, clock_jump_s=-2), 2)
    steps = np.diff([float(s.rgb_stamp) for s in behind])
    assert np.flatnonzero(steps < 0).tolist() == [49]
    assert steps[49] == pytest.approx(-1.9, abs=1e-3)
    names = [s.rgb_stamp for s in behind]
    assert len(set(names)) == len(names)


def test_a_frozen_stream_on_disk(tmp_path: Path) -> None:
    simulate(plan(), tmp_path / "a", frames=5, effects={"freeze_every_s": 0.2, "freeze_s": 0.15})
    images = [path.read_bytes() for path in sorted((tmp_path / "a" / "rgb").iterdir())]
    assert [a == b for a, b in itertools.pairwise(images)] == [False, True, True, True]
    poses = np.loadtxt(tmp_path / "a" / "groundtruth.txt")
    assert (np.linalg.norm(np.diff(poses[:, 1:4], axis=0), axis=1) > 0).all()  # the camera went on
    assert len(stamps(tmp_path / "a" / "rgb.txt")) == 5


def test_the_field_of_view(tmp_path: Path) -> None:
    simulate(plan(), tmp_path / "a", frames=1, effects={"fov_deg": 90}, output=Output(labels_every=0))
    assert "fx: 48.0" in (tmp_path / "a" / "camera.yaml").read_text().replace("48.00000000000001", "48.0")


def test_every_effect_is_documented() -> None:
    text = (Path(__file__).parent.parent / "docs" / "simulator.md").read_text()
    assert [name for name in effect_names() if f"`{name}`" not in text] == []
