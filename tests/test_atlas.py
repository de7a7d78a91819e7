"""Saved atlases: what a run leaves for the next one, and what goes wrong with such files."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import Program, one_line_error, report
from layouts import Scene, write_tum

import vsgraphs as package
from vsgraphs.scene_graph import SceneGraph
from vsgraphs.trajectory import read_tum_trajectory

COUNTS = ("keyframes", "landmarks", "planes", "rooms", "floors", "doors", "markers", "maps")


NEWEST = 5  # version of the atlas format


@pytest.fixture(scope="module")
def walked(recorded: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The directory of a run along the wall that left atlas.vsg."""
    out = tmp_path_factory.mktemp("walked")
    command = [sys.executable, "-m", "vsgraphs", "run", str(recorded), "--out", str(out)]
    done = subprocess.run(
        [*command, "--save-atlas", str(out / "atlas.vsg"), "--execution", "serial"],
        check=True,
        capture_output=True,
        text=True,
    )
    assert f"saved in {out / 'atlas.vsg'}: 1 map, " in done.stdout
    return out


def test_info_counts_what_the_run_counted(walked: Path, vsgraphs: Program) -> None:
    atlas, run = walked / "atlas.vsg", report(walked)
    done = vsgraphs("info", atlas, "--json")
    assert done.returncode == 0, done.stderr
    info = json.loads(done.stdout)
    assert all(isinstance(info[key], int) for key in COUNTS)
    assert info["maps"] == len(info["each"]) == 1
    assert (info["keyframes"], info["landmarks"]) == (run["keyframes"], run["landmarks"])
    assert (info["planes"], info["rooms"]) == (run["scene"]["planes"], run["scene"]["rooms"])
    assert info["format"] == NEWEST
    assert (info["program"], info["commit"]) == (run["versions"]["vsgraphs"], run["commit"])
    assert (info["camera"]["width"], info["camera"]["fx"]) == (320, 300.0)
    assert info["mode"] == "full"
    assert info["bytes"] == atlas.stat().st_size
    assert info["bytes"] < 1e6 * info["keyframes"]
    told = vsgraphs("info", atlas).stdout
    assert "camera 320x240, fx 300.0" in told
    assert str(info["landmarks"]) in told


def test_saving_what_was_loaded_gives_the_same_bytes(walked: Path, tmp_path: Path) -> None:
    atlas = package.load_atlas(walked / "atlas.vsg")
    atlas.save(tmp_path / "again.vsg")
    assert (tmp_path / "again.vsg").read_bytes() == (walked / "atlas.vsg").read_bytes()


def test_what_python_sees_of_an_atlas(walked: Path) -> None:
    atlas = package.load_atlas(walked / "atlas.vsg")
    assert len(atlas) == 1
    assert not atlas.empty
    assert atlas.camera.width == 320
    assert 'system.execution: "serial"\n' in atlas.configuration
    snapshot = atlas.snapshot()
    ids, stamps, poses = snapshot.keyframes()
    kept = read_tum_trajectory(walked / "keyframes.txt")
    np.testing.assert_allclose(stamps, kept.timestamps, atol=1e-6)
    assert poses.shape == (len(ids), 4, 4)
    graph = SceneGraph.from_map(snapshot.scene_graph(), (ids, stamps, poses))
    assert len(graph.planes) == atlas.info()["planes"]
    with pytest.raises(IndexError, match="map 1 of 1"):
        atlas.snapshot(1)


def test_python_asks_an_atlas_for_places_that_look_alike(walked: Path) -> None:
    atlas = package.load_atlas(walked / "atlas.vsg")
    ids, _, poses = atlas.snapshot().keyframes()
    places = poses[:, :3, 3]
    last = int(ids[-1])
    with pytest.raises(ValueError, match="negative"):
        atlas.similar_places(last, count=-1)
    similar = atlas.similar_places(last, gap=1, count=3)
    scores = [score for _, score in similar]
    assert 1 <= len(similar) <= 3
    assert scores == sorted(scores, reverse=True)
    assert all(0 < score <= 1 for score in scores)
    # Along a painted wall the nearest looks most alike.
    nearest = int(ids[np.linalg.norm(places[:-1] - places[-1], axis=1).argmin()])
    assert similar[0][0] == nearest
    assert all(number + 2 <= last for number, _ in atlas.similar_places(last, gap=2))
    assert atlas.similar_places(int(ids[0])) == []
    with pytest.raises(IndexError, match="keyframe 100000 is not in the map"):
        atlas.similar_places(100000)


def test_the_configuration_of_an_atlas_is_read_by_run(
    walked: Path, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    settings = tmp_path / "settings.yaml"
    settings.write_text(package.load_atlas(walked / "atlas.vsg").configuration)
    done = vsgraphs("run", recorded, "--out", tmp_path / "o", "--config", settings, "--max-frames", 2)
    assert done.returncode == 0, done.stderr
    assert report(tmp_path / "o")["configuration"] == report(walked)["configuration"]


def test_a_second_run_goes_on_in_the_frame_of_the_first(
    walked: Path, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    out = tmp_path / "out"
    done = vsgraphs(
        *("run", recorded, "--out", out, "--load-atlas", walked / "atlas.vsg", "--execution", "serial"),
        *("--save-atlas", out / "more.vsg"),
    )
    assert done.returncode == 0, done.stderr
    assert f"{walked / 'atlas.vsg'}: 1 map, " in done.stdout
    first = read_tum_trajectory(walked / "trajectory.txt")
    second = read_tum_trajectory(out / "trajectory.txt")
    assert len(second) > 55
    common = np.isin(first.timestamps.round(6), second.timestamps.round(6))
    assert np.linalg.norm(first.positions[common] - second.positions, axis=1).max() < 0.02
    info = package.load_atlas(out / "more.vsg").info()
    assert info["maps"] == 1
    # The same way once more: the map is as large as it was, give or take what another sight makes redundant.
    before = package.load_atlas(walked / "atlas.vsg").info()["keyframes"]
    assert 0.7 * before <= info["keyframes"] <= 1.3 * before


def test_localising_only_leaves_the_maps_as_they_are(
    walked: Path, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    out = tmp_path / "out"
    done = vsgraphs(
        *("run", recorded, "--out", out, "--load-atlas", walked / "atlas.vsg", "--localise-only"),
        *("--save-atlas", out / "same.vsg"),
    )
    assert done.returncode == 0, done.stderr
    first = read_tum_trajectory(walked / "trajectory.txt")
    second = read_tum_trajectory(out / "trajectory.txt")
    assert len(second) > 55
    common = np.isin(first.timestamps.round(6), second.timestamps.round(6))
    assert np.linalg.norm(first.positions[common] - second.positions, axis=1).max() < 0.02
    before, after = (package.load_atlas(path) for path in (walked / "atlas.vsg", out / "same.vsg"))
    assert {key: after.info()[key] for key in COUNTS} == {key: before.info()[key] for key in COUNTS}
    np.testing.assert_array_equal(after.snapshot().landmarks()[0], before.snapshot().landmarks()[0])


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_what_an_ended_run_leaves(recorded: Path, tmp_path: Path, number: signal.Signals) -> None:
    """Ctrl-C: saved at the end. kill -9: the last autosave loads."""
    out = tmp_path / "out"
    command = [sys.executable, "-m", "vsgraphs", "run", str(recorded), "--out", str(out), "--realtime"]
    atlas = out / "atlas.vsg"
    with subprocess.Popen(
        [*command, "--autosave", "0.3"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        deadline = time.monotonic() + 60
        while not atlas.exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        time.sleep(0.7)  # so that some saving is under way or not, as it happens
        process.send_signal(number)
        process.communicate(timeout=60)
    assert process.returncode in (130, -9)
    loaded = package.load_atlas(atlas)
    assert loaded.info()["keyframes"] >= 1
    if number == signal.SIGINT:
        assert loaded.info()["keyframes"] == report(out)["keyframes"]
        assert not list(out.glob(".*.part"))


def test_an_empty_map_is_saved_and_loaded(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    dark = write_tum(tmp_path / "dark", _Blind(frames=3, width=320, height=240, focal_px=300.0))
    empty = tmp_path / "empty.vsg"
    done = vsgraphs("run", dark, "--out", tmp_path / "a", "--save-atlas", empty)
    assert "no frame of" in one_line_error(done)
    assert f"saved in {empty}: an empty map" in done.stdout
    assert "an empty map" in vsgraphs("info", empty).stdout
    assert json.loads(vsgraphs("info", empty, "--json").stdout)["keyframes"] == 0
    done = vsgraphs("run", recorded, "--out", tmp_path / "b", "--load-atlas", empty, "--max-frames", 5)
    assert done.returncode == 0, done.stderr
    assert f"{empty}: holds an empty map, starting anew" in done.stdout
    done = vsgraphs("run", recorded, "--out", tmp_path / "b", "--load-atlas", empty, "--localise-only")
    assert "holds an empty map" in one_line_error(done)


class _Blind(Scene):
    def depth(self, index: int) -> np.ndarray:
        return np.zeros((self.height, self.width), np.uint16)


def test_a_camera_of_another_size(walked: Path, tmp_path: Path, vsgraphs: Program) -> None:
    small = write_tum(tmp_path / "small", Scene(frames=3, width=160, height=120, focal_px=150.0))
    done = vsgraphs("run", small, "--out", tmp_path / "o", "--load-atlas", walked / "atlas.vsg")
    error = one_line_error(done)
    assert "was mapped with images of 320x240 pixels, and this camera's have 160x120" in error
    assert str(walked / "atlas.vsg") in error


def test_a_mode_that_would_leave_rooms_untended(
    walked: Path, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    done = vsgraphs(
        "run", recorded, "--out", tmp_path / "o", "--load-atlas", walked / "atlas.vsg", "--mode", "slam"
    )
    assert "was mapped with --mode full, and --mode slam would leave" in one_line_error(done)


def test_localise_only_without_an_atlas(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    done = vsgraphs("run", recorded, "--out", tmp_path / "o", "--localise-only")
    assert "give --load-atlas FILE" in one_line_error(done)


def test_files_that_are_no_atlas(recorded: Path, walked: Path, tmp_path: Path, vsgraphs: Program) -> None:
    whole = (walked / "atlas.vsg").read_bytes()
    cut, changed, other, newer = (tmp_path / name for name in ("cut", "changed", "other", "newer"))
    cut.write_bytes(whole[: len(whole) // 2])
    changed.write_bytes(whole[:5000] + bytes([whole[5000] ^ 1]) + whole[5001:])
    other.write_text("timestamp tx ty tz qx qy qz qw\n" * 10)
    newer.write_bytes(_of_version(whole, NEWEST + 1))
    for path, message in (
        (cut, "is damaged (it ends too early)"),
        (changed, "has changed)"),
        (other, "is no vsgraphs atlas"),
        (
            newer,
            f"was saved in version {NEWEST + 1} of the atlas format, and this vsgraphs reads up to version "
            f"{NEWEST}; update",
        ),
        (tmp_path / "missing", "cannot read"),
        (tmp_path, "it is a folder"),
    ):
        run = ("run", recorded, "--out", tmp_path / "o", "--load-atlas", path)
        for command in (run,) if path.is_dir() else (run, ("info", path)):  # info of a directory: of a run
            error = one_line_error(vsgraphs(*command))
            assert message in error
            assert str(path) in error
        with pytest.raises(package.InputError, match=path.name):
            package.load_atlas(path)


def _of_version(whole: bytes, version: int) -> bytes:
    """The file with another version and the checksum that goes with it (core/base/archive.h)."""
    mask = (1 << 64) - 1

    def checksum(data: bytes, start: int) -> int:
        words = [len(data)]
        full = len(data) // 8 * 8
        words += [int.from_bytes(data[at : at + 8], "little") for at in range(0, full, 8)]
        words.append(int.from_bytes(data[full:], "little"))
        for word in words:
            start = (start ^ word) * 0x100000001B3 & mask
            start ^= start >> 32
        return start

    first = whole[:8] + version.to_bytes(4, "little") + whole[12:16]
    rest = int.from_bytes(whole[12:16], "little")
    table = whole[24 : 24 + rest]
    assert checksum(table, checksum(whole[:16], 0xCBF29CE484222325)) == int.from_bytes(whole[16:24], "little")
    total = checksum(table, checksum(first, 0xCBF29CE484222325))
    return first + total.to_bytes(8, "little") + whole[24:]


def test_places_that_cannot_be_written_are_told_before_the_run(
    recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    (tmp_path / "folder").mkdir()
    for path, message in (
        (tmp_path / "missing" / "a.vsg", "there is no folder"),
        (tmp_path / "folder", "it names a folder"),
        (Path("/dev/full"), "it is no ordinary file"),
    ):
        done = vsgraphs("run", recorded, "--out", tmp_path / "o", "--save-atlas", path)
        assert message in one_line_error(done)
        assert not (tmp_path / "o" / "trajectory.txt").exists()


def run_on_a_full_disk(
    walked: Path, recorded: Path, folder: Path, vsgraphs: Program, *options: object
) -> Path:
    """Saves over an atlas where a limit on the size of files stands for the disk; returns the atlas."""
    target = folder / "atlas.vsg"
    target.write_bytes((walked / "atlas.vsg").read_bytes())

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (400_000, 400_000))
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

    done = vsgraphs(
        *("run", recorded, "--out", folder / "o", "--max-frames", 30, "--save-atlas", target),
        *("--overwrite", *options),
        preexec_fn=limited,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
    )
    assert f"cannot write {target}: File too large" in one_line_error(done)
    assert not list(folder.glob(".*.part"))
    assert report(folder / "o")["tracked"] == 30  # the rest is there
    return target


def test_a_full_disk_leaves_the_old_file(
    walked: Path, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    target = run_on_a_full_disk(walked, recorded, tmp_path, vsgraphs)
    assert target.read_bytes() == (walked / "atlas.vsg").read_bytes()


def test_autosave_on_a_full_disk_is_told_once(
    walked: Path, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    target = run_on_a_full_disk(
        walked, recorded, tmp_path, vsgraphs, "--autosave", "0.2", "--set", "system.realtime=true"
    )
    # The old file, or a whole one saved while the map was still small.
    assert vsgraphs("info", target).returncode == 0
    warnings = [
        line for line in report(tmp_path / "o")["warnings"] if line.startswith("autosave: cannot write")
    ]
    assert len(warnings) == 1  # however often it happened


def test_a_run_in_a_room_comes_back_byte_for_byte(tmp_path: Path, vsgraphs: Program) -> None:
    """With rooms, merged landmarks and culled keyframes."""
    folder, out = tmp_path / "room", tmp_path / "out"
    done = vsgraphs(
        "simulate", "one_room", "--out", folder, "--every", 10, "--frames", 60, "--labels-every", 0
    )
    assert done.returncode == 0, done.stderr
    done = vsgraphs("run", folder, "--out", out, "--execution", "serial", "--save-atlas", out / "a.vsg")
    assert done.returncode == 0, done.stderr
    began = time.monotonic()
    atlas = package.load_atlas(out / "a.vsg")
    took_s = time.monotonic() - began
    info = atlas.info()
    assert info["planes"] >= 3
    assert (
        took_s < 0.01 * info["keyframes"] + 0.2
    )  # 500 keyframes below a second, with room for a busy machine
    atlas.save(out / "b.vsg")
    assert (out / "a.vsg").read_bytes() == (out / "b.vsg").read_bytes()
    scene = report(out)["scene"]
    assert {key: info[key] for key in ("planes", "rooms", "floors", "doors")} == {
        key: scene[key] for key in ("planes", "rooms", "floors", "doors")
    }
