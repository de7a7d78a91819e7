"""What a run does with an atlas that is there already: nothing that somebody may want back is lost."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import Program, one_line_error
from layouts import Scene, write_tum

import vsgraphs as package
from vsgraphs.export.lock import Locks


@pytest.fixture(scope="module")
def mapped(recorded: Path, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """An atlas of some frames."""
    folder = tmp_path_factory.mktemp("mapped")
    command = [sys.executable, "-m", "vsgraphs", "run", str(recorded), "--out", str(folder / "out")]
    subprocess.run(
        [*command, "--save-atlas", str(folder / "house.vsg"), "--max-frames", "20"],
        check=True,
        capture_output=True,
    )
    return (folder / "house.vsg").read_bytes()


@pytest.fixture
def house(mapped: bytes, tmp_path: Path) -> Path:
    path = tmp_path / "house.vsg"
    path.write_bytes(mapped)
    return path


class _Blind(Scene):
    def depth(self, index: int) -> np.ndarray:
        return np.zeros((self.height, self.width), np.uint16)


def names(folder: Path) -> set[str]:
    return {entry.name for entry in folder.iterdir()}


@pytest.mark.parametrize("options", [(), ("--autosave", "0.1")])
def test_a_run_that_maps_nothing_replaces_nothing(
    house: Path, mapped: bytes, tmp_path: Path, options: tuple[str, ...], vsgraphs: Program
) -> None:
    dark = write_tum(tmp_path / "dark", _Blind(frames=3, width=320, height=240, focal_px=300.0))
    done = vsgraphs("run", dark, "--out", tmp_path / "o", "--save-atlas", house, "--overwrite", *options)
    assert "no frame of" in one_line_error(done)
    assert f"{house}: left as it is, since this run has mapped nothing\n" in done.stdout
    assert "saved in" not in done.stdout
    assert house.read_bytes() == mapped
    assert names(tmp_path) == {"house.vsg", "dark", "o"}


def test_a_file_that_is_not_the_runs_own_is_refused_before_it_begins(
    house: Path, mapped: bytes, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    done = vsgraphs("run", recorded, "--out", tmp_path / "o", "--save-atlas", house)
    error = one_line_error(done)
    assert f"{house}: is there, and this run does not start from it" in error
    assert "--overwrite" in error
    assert not (tmp_path / "o" / "trajectory.txt").exists()
    assert house.read_bytes() == mapped
    (tmp_path / "o" / "atlas.vsg").write_bytes(mapped)  # as an autosave has left it
    done = vsgraphs("run", recorded, "--out", tmp_path / "o", "--autosave", "9")
    assert f"{tmp_path / 'o' / 'atlas.vsg'}: is there" in one_line_error(done)


def test_going_on_in_a_file_through_a_link(
    house: Path, mapped: bytes, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    link = tmp_path / "o" / "link.vsg"
    link.parent.mkdir()
    link.symlink_to(house)
    run = ("run", recorded, "--max-frames", 30, "--out", tmp_path / "o", "--save-atlas", link)
    done = vsgraphs(*run, "--load-atlas", house, "--autosave", "0.1")
    assert done.returncode == 0, done.stderr
    assert link.is_symlink()
    assert house.read_bytes() != mapped
    assert (tmp_path / "house.vsg.1").read_bytes() == mapped
    assert names(tmp_path) == {"house.vsg", "house.vsg.1", "o"}

    done = vsgraphs(*run, "--load-atlas", link, "--keep", "2")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "house.vsg.2").read_bytes() == mapped
    now, before, first = (package.load_atlas(tmp_path / f"house.vsg{end}") for end in ("", ".1", ".2"))
    assert (now.parent, before.parent, first.parent) == (before.revision, first.revision, None)
    assert now.lineage == before.lineage == first.lineage == first.revision

    info = json.loads(vsgraphs("info", link, "--json").stdout)
    assert [info[key] for key in ("revision", "parent", "lineage")] == [now.revision, now.parent, now.lineage]
    kept = [tmp_path / "house.vsg.1", tmp_path / "house.vsg.2"]
    assert [(version["file"], version["bytes"], version["revision"]) for version in info["kept"]] == [
        (str(path), path.stat().st_size, atlas.revision)
        for path, atlas in zip(kept, (before, first), strict=True)
    ]
    told = vsgraphs("info", house).stdout.splitlines()
    assert told[-2].startswith(f"kept: {kept[0]}, ")
    assert told[-2].endswith(", what this one was made from")
    assert told[-1].startswith(f"kept: {kept[1]}, ")


def test_overwriting_keeps_too_unless_told_otherwise(
    house: Path, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    house.write_text("a letter")
    run = ("run", recorded, "--out", tmp_path / "o", "--max-frames", 3, "--save-atlas", house)
    assert "no atlas that can be read" in one_line_error(vsgraphs(*run, "--load-atlas", tmp_path / "none"))
    assert vsgraphs(*run, "--overwrite").returncode == 0
    assert (tmp_path / "house.vsg.1").read_text() == "a letter"
    assert vsgraphs(*run, "--overwrite", "--keep", 0).returncode == 0
    assert (tmp_path / "house.vsg.1").read_text() == "a letter"
    assert vsgraphs("info", house).stdout.splitlines()[-1].endswith(", no atlas")


def test_where_nothing_can_be_kept_the_run_is_saved_beside(
    house: Path, mapped: bytes, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    (tmp_path / "house.vsg.1" / "x").mkdir(parents=True)
    run = ("run", recorded, "--out", tmp_path / "o", "--max-frames", 5, "--save-atlas", house)
    done = vsgraphs(*run, "--load-atlas", house)
    assert done.returncode == 0, done.stderr
    assert "cannot be kept as" in done.stderr
    assert f"saved in {tmp_path / 'house-1.vsg'}: 1 map" in done.stdout
    assert package.load_atlas(tmp_path / "house-1.vsg").parent == package.load_atlas(house).revision
    assert house.read_bytes() == mapped


def test_a_version_that_came_meanwhile_stays(
    house: Path, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    other = tmp_path / "other.vsg"
    assert (
        vsgraphs(
            "run", recorded, "--out", tmp_path / "o", "--max-frames", 3, "--save-atlas", other
        ).returncode
        == 0
    )
    theirs = other.read_bytes()
    command = [sys.executable, "-m", "vsgraphs", "run", str(recorded), "--out", str(tmp_path / "o")]
    command += ["--load-atlas", str(house), "--save-atlas", str(house), "--realtime"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        while not process.stdout.readline().startswith(f"{house}: 1 map"):  # loaded
            assert process.poll() is None
        other.replace(house)
        out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    assert f"warning: {house} was changed by another program while this one ran, and is left as it is" in err
    assert f"saved in {tmp_path / 'house-1.vsg'}: 1 map" in out
    assert house.read_bytes() == theirs
    assert package.load_atlas(tmp_path / "house-1.vsg").info()["keyframes"] >= 1


def test_two_programs_write_neither_one_atlas_nor_one_folder(
    house: Path, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    out = tmp_path / "o"
    out.mkdir()
    run = ("run", recorded, "--max-frames", 3)
    with Locks(print) as locks:
        locks.hold_file(house)
        error = one_line_error(vsgraphs(*run, "--out", out, "--load-atlas", house, "--save-atlas", house))
        assert error.startswith(f"error: {house}: another vsgraphs writes there (process {os.getpid()}); ")
        assert names(out) == set()
        # Whoever only reads is not held up.
        assert vsgraphs("info", house).returncode == 0
        assert vsgraphs(*run, "--out", out, "--load-atlas", house).returncode == 0
        locks.hold_folder(out)
        before = {entry: entry.stat().st_mtime_ns for entry in out.iterdir()}
        error = one_line_error(vsgraphs(*run, "--out", out))
        assert error.startswith(f"error: {out}: another vsgraphs writes there (process {os.getpid()}); ")
        assert before == {entry: entry.stat().st_mtime_ns for entry in out.iterdir()}
    assert vsgraphs(*run, "--out", out, "--load-atlas", house, "--save-atlas", house).returncode == 0
    assert ".lock" not in names(out)
    assert names(tmp_path) == {"house.vsg", "house.vsg.1", "o"}


def test_serial_runs_save_the_same_bytes(
    house: Path, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    for name in ("a", "b"):
        done = vsgraphs(
            *("run", recorded, "--out", tmp_path / name, "--max-frames", 25, "--execution", "serial"),
            *("--load-atlas", house, "--save-atlas", tmp_path / f"{name}.vsg"),
        )
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "a.vsg").read_bytes() == (tmp_path / "b.vsg").read_bytes()
