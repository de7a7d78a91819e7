"""The Python API as a user meets it."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from layouts import Scene, write_tum

import vsgraphs

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture
def scene() -> Scene:
    return Scene(frames=20, width=320, height=240, focal_px=300.0, shifts_px=[2 * i for i in range(20)])


@pytest.fixture
def camera(scene: Scene) -> vsgraphs.Camera:
    return vsgraphs.Camera(320, 240, 300.0, 300.0, 159.5, 119.5, fps=10.0, depth_scale=5000.0)


def test_the_example_runs(scene: Scene, tmp_path: Path) -> None:
    folder = write_tum(tmp_path / "slide", scene)
    command = [sys.executable, ROOT / "examples" / "track_folder.py", folder]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    *_, tracked, end = done.stdout.splitlines()
    assert tracked == "20 of 20 frames tracked"
    position = np.array(end.removeprefix("the path ends at [").removesuffix("]").split(), float)
    assert np.abs(position - scene.pose(19)[:3, 3]).max() < 0.01


def test_the_example_of_the_readme_runs(scene: Scene, tmp_path: Path) -> None:
    folder = write_tum(tmp_path / "slide", scene)
    blocks = [rest.partition("```")[0] for rest in (ROOT / "README.md").read_text().split("```python\n")[1:]]
    program = "\n".join([*blocks, "print(len(poses), rooms)"]).replace("path/to/sequence", str(folder))
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    result, last = done.stdout.splitlines()
    assert result.startswith("20 {} [")
    assert "trajectory.txt" in result
    assert last.split() == ["20", "{}"], "a wall of paint, seen for two seconds, is no room"


@pytest.mark.parametrize("depth_in_metres", [False, True])
@pytest.mark.parametrize("grey", [False, True])
def test_track(scene: Scene, camera: vsgraphs.Camera, depth_in_metres: bool, grey: bool) -> None:
    slam = vsgraphs.Slam(vsgraphs.Config(), camera)
    for i in range(scene.frames):
        rgb = np.ascontiguousarray(scene.rgb(i))
        if grey:
            rgb = np.ascontiguousarray(rgb[:, :, 1])
        depth = scene.depth(i)
        result = slam.track(
            rgb, (depth / 5000).astype(np.float32) if depth_in_metres else depth, scene.stamp(i)
        )
        assert result.tracked
        assert result.world_from_camera.shape == (4, 4)
    slam.finish()
    stamps, poses = slam.trajectory()
    assert (stamps.shape, poses.shape, poses.dtype) == ((20,), (20, 4, 4), np.float64)
    assert poses[-1, 0, 3] == pytest.approx(scene.pose(19)[0, 3], abs=0.01)
    positions, colours = slam.snapshot().landmarks()
    assert positions.shape == colours.shape
    assert (positions.dtype, colours.dtype) == (np.float64, np.uint8)
    ids, keyframe_stamps, keyframe_poses = slam.snapshot().keyframes()
    assert len(ids) == len(keyframe_stamps) == len(keyframe_poses) >= 1


def test_what_is_wrong_with_an_image_is_said(scene: Scene, camera: vsgraphs.Camera) -> None:
    slam = vsgraphs.Slam(vsgraphs.Config(), camera)
    rgb, depth = np.ascontiguousarray(scene.rgb(0)), scene.depth(0)
    slam.track(rgb, depth, 1.0)
    for bad_rgb, bad_depth, stamp, word in [
        (rgb[:100], depth[:100], 2.0, "320"),
        (rgb.astype(np.float32), depth, 2.0, "uint8"),
        (rgb, depth.astype(np.float64), 2.0, "float32"),
        (rgb, depth[:, :100], 2.0, "depth"),
        (rgb[:, ::2], depth, 2.0, "rgb"),
        (rgb, depth, 1.0, "timestamp"),
        (rgb, depth, 0.5, "timestamp"),
        (rgb, depth, float("nan"), "timestamp"),
        (rgb, depth, 1e300, "timestamp 1e.300 s is beyond any time in seconds"),
        (rgb, depth, 1.7e18, "give seconds"),
    ]:
        with pytest.raises(vsgraphs.InputError, match=word) as caught:
            slam.track(bad_rgb, bad_depth, stamp)
        assert "\n" not in str(caught.value)
    assert slam.track(rgb, depth, 2.0).tracked  # nothing was harmed


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda rgb, depth: (rgb / 255, depth),
            r"rgb: must be uint8 .*, not float64 of shape \(240, 320, 3\); from 0",
        ),
        (lambda rgb, depth: (rgb.astype(np.int8), depth), r"rgb: must be uint8 .*, not int8 of shape"),
        (lambda rgb, depth: (rgb.astype(bool), depth), r"rgb: must be uint8 .*, not bool of shape"),
        (
            lambda rgb, depth: (rgb.astype(np.complex64), depth),
            r"rgb: must be uint8 .*, not complex64 of shape",
        ),
        (lambda rgb, depth: (rgb.astype(">u2"), depth), r"rgb: must be uint8 .*, not >u2"),
        (lambda rgb, depth: (rgb.astype(object), depth), r"rgb: must be uint8 .*, not object"),
        (lambda rgb, depth: (rgb.astype(str), depth), r"rgb: must be uint8 .*, not <U"),
        (
            lambda rgb, depth: (depth, rgb),
            r"rgb: must be uint8 .*, not uint16 .*; are rgb and depth in each other's",
        ),
        (
            lambda rgb, depth: (np.dstack([rgb, rgb[:, :, :1]]), depth),
            r"not uint8 of shape \(240, 320, 4\); leave out",
        ),
        (
            lambda rgb, depth: (np.moveaxis(rgb, 2, 0).copy(), depth),
            r"shape \(3, 240, 320\); the channels come last",
        ),
        (
            lambda rgb, depth: (rgb[None], depth),
            r"rgb: must be uint8 .*, not uint8 of shape \(1, 240, 320, 3\)",
        ),
        (lambda rgb, depth: (rgb[0, :, 0], depth), r"rgb: must be uint8 .*, not uint8 of shape \(320,\)"),
        (lambda rgb, depth: (rgb[0, 0, 0], depth), r"rgb: must be uint8"),
        (lambda rgb, depth: (rgb[:, ::-1], depth), r"rgb: the image's rows are not contiguous"),
        (lambda rgb, depth: (rgb[::-1], depth), r"rgb: the image's rows are not contiguous"),
        (lambda rgb, depth: (np.asfortranarray(rgb), depth), r"rgb: the image's rows are not contiguous"),
        (lambda rgb, depth: (rgb[:0], depth), r"rgb: the image is empty"),
        (
            lambda rgb, depth: (rgb, depth.astype(np.int32)),
            r"depth: must be uint16 .* or float32 .*, not int32 of shape",
        ),
        (
            lambda rgb, depth: (rgb, depth.astype(np.float64)),
            r"not float64 .*; metres: depth.astype\(numpy.float32\)",
        ),
        (lambda rgb, depth: (rgb, depth.astype(np.float16)), r"depth: must be .*, not float16 of shape"),
        (lambda rgb, depth: (rgb, depth.astype(">u2")), r"depth: must be uint16 .*, not >u2"),
        (
            lambda rgb, depth: (rgb, depth[:, :, None]),
            r"not uint16 of shape \(240, 320, 1\); take depth\[:, :, 0\]",
        ),
        (lambda rgb, depth: (rgb, depth.T), r"depth"),
        (lambda rgb, depth: (rgb, depth[::2, ::2]), r"depth"),
    ],
)
def test_an_array_s_type_and_shape_are_told_as_they_are(
    scene: Scene, camera: vsgraphs.Camera, change: Any, message: str
) -> None:
    slam = vsgraphs.Slam(vsgraphs.Config(), camera)
    rgb, depth = np.ascontiguousarray(scene.rgb(0)), scene.depth(0)
    with pytest.raises(vsgraphs.InputError, match=message) as caught:
        slam.track(*change(rgb, depth), 1.0)
    assert "\n" not in str(caught.value)
    assert slam.track(rgb, depth, 1.0).tracked


def test_what_is_no_array_is_told(scene: Scene, camera: vsgraphs.Camera) -> None:
    slam = vsgraphs.Slam(vsgraphs.Config(), camera)
    rgb, depth = np.ascontiguousarray(scene.rgb(0)), scene.depth(0)
    for bad, name in (([[1]], "list"), ("x", "str"), (None, "NoneType")):
        with pytest.raises(TypeError, match=f"rgb: must be a numpy array, not {name}"):
            slam.track(bad, depth, 1.0)
        with pytest.raises(TypeError, match=f"depth: must be a numpy array, not {name}"):
            slam.track(rgb, bad, 1.0)
    index = slam.track(rgb, depth, 1.0).index
    roles = np.zeros((6, 8), np.uint8)
    with pytest.raises(
        vsgraphs.InputError, match=r"segmentation: roles: must be uint8 .*, not int64 of shape \(6, 8\)"
    ):
        slam.add_segmentation(index, roles.astype(np.int64))
    with pytest.raises(
        vsgraphs.InputError, match=r"segmentation: confidence: must be float32 .*, not float64"
    ):
        slam.add_segmentation(index, roles, roles.astype(np.float64))
    with pytest.raises(vsgraphs.InputError, match=r"segmentation: instances: must be uint16 .*, not uint8"):
        slam.add_segmentation(index, roles, None, roles)
    slam.add_segmentation(index, roles, roles.astype(np.float32), roles.astype(np.uint16))


def test_a_run_starts_from_the_maps_of_another(scene: Scene, camera: vsgraphs.Camera) -> None:
    config = vsgraphs.Config()
    config.set("system.execution", "serial")
    first = vsgraphs.Slam(config, camera)
    for i in range(scene.frames):
        first.track(scene.rgb(i), scene.depth(i), scene.stamp(i))
    first.finish()
    atlas = first.atlas_state()
    assert atlas.maps == 1
    assert atlas.keyframes == len(first.snapshot().keyframes()[0]) > 1

    second = vsgraphs.Slam(config, camera, atlas=atlas)
    result = second.track(scene.rgb(9), scene.depth(9), 0.0)
    assert result.status == "relocalised"
    assert result.index > 0, "frames are counted on"
    assert result.world_from_camera[0, 3] == pytest.approx(scene.pose(9)[0, 3], abs=0.01)
    second.finish()
    statistics = second.statistics()
    assert (statistics["maps"], statistics["loops"], statistics["merges"]) == (1, 0, 0)
    for kind in ("loop_candidates", "join_candidates"):
        assert set(statistics[kind]) == {"verdicts", "nearest_refused"}

    config.set("system.localise_only", True)
    with pytest.raises(vsgraphs.InputError, match="load an atlas"):
        vsgraphs.Slam(config, camera)
    located = vsgraphs.Slam(config, camera, atlas=atlas)
    assert located.track(scene.rgb(4), scene.depth(4), 0.0).tracked
    located.finish()
    assert located.atlas_state().keyframes == atlas.keyframes


def test_a_live_camera_never_waits_for_mapping(scene: Scene, camera: vsgraphs.Camera) -> None:
    slam = vsgraphs.Slam(vsgraphs.Config(), camera, realtime=True)
    for i in range(scene.frames):
        slam.track(scene.rgb(i), scene.depth(i), scene.stamp(i))
    slam.finish()
    assert slam.statistics()["waited_s"] == 0.0
    assert len(slam.trajectory()[0]) == scene.frames

    serial = vsgraphs.Config()
    serial.set("system.execution", "serial")
    with pytest.raises(vsgraphs.InputError, match="threaded"):
        vsgraphs.Slam(serial, camera, realtime=True)
    vsgraphs.Slam(serial, camera, realtime=False)


def test_config_and_camera_mistakes(camera: vsgraphs.Camera) -> None:
    config = vsgraphs.Config()
    with pytest.raises(vsgraphs.InputError, match=r"system\.seed"):
        config.set("sistem.seed", 3)
    with pytest.raises(vsgraphs.InputError, match="fx"):
        vsgraphs.Camera(640, 480, -1.0, 525.0, 319.5, 239.5)


def test_tracking_releases_the_interpreter(scene: Scene, camera: vsgraphs.Camera) -> None:
    slam = vsgraphs.Slam(vsgraphs.Config(), camera)
    images = [np.ascontiguousarray(scene.rgb(i)) for i in range(5)]
    ticks = 0
    inside = threading.Event()
    done = threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not done.is_set():
            if inside.is_set():
                ticks += 1

    interval = sys.getswitchinterval()
    sys.setswitchinterval(0.2)  # so that the thread can only count if the lock is let go
    counter = threading.Thread(target=tick)
    try:
        counter.start()
        inside.set()
        for i, image in enumerate(images):
            slam.track(image, scene.depth(i), scene.stamp(i))
        inside.clear()
    finally:
        done.set()
        sys.setswitchinterval(interval)
        counter.join()
    assert ticks > 100


def test_names_are_listed_and_typed() -> None:
    assert set(vsgraphs.__all__) <= set(dir(vsgraphs))
    for name in vsgraphs.__all__:
        assert getattr(vsgraphs, name) is not None
    assert (Path(vsgraphs.__file__).parent / "py.typed").exists()
    with pytest.raises(AttributeError, match="no attribute 'Slamm'"):
        vsgraphs.Slamm  # noqa: B018


def loaded_by(statement: str, *modules: str) -> list[str]:
    code = f"{statement}; import sys; print(*[m for m in {modules} if m in sys.modules])"
    return subprocess.check_output([sys.executable, "-c", code], text=True).split()


def test_importing_the_package_loads_nothing_heavy() -> None:
    assert loaded_by("import vsgraphs", "numpy", "vsgraphs._core", "matplotlib") == []


def test_running_does_not_load_what_only_other_commands_need() -> None:
    assert loaded_by("import vsgraphs.cli.run", "matplotlib", "rich", "typer") == []
