"""The command `simulate`; what it renders is tested in test_simulate.py."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import Program, one_line_error

from vsgraphs.datasets import open_sequence
from vsgraphs.errors import InputError
from vsgraphs.export.lock import Locks
from vsgraphs.plans import building
from vsgraphs.simulate.folder import FolderInTheMaking


def test_a_few_frames_of_an_included_plan(tmp_path: Path, vsgraphs: Program) -> None:
    done = vsgraphs("simulate", "one_room", "--out", tmp_path / "room", "--frames", 4, "--noise", "clean")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("4 frames, ")
    sequence = open_sequence(tmp_path / "room")
    assert (sequence.format, len(sequence.frames), sequence.warnings) == ("TUM RGB-D", 4, [])
    rgb, depth = sequence.frames[3].load()
    assert rgb.shape == (*depth.shape, 3)
    assert np.count_nonzero(depth) > depth.size / 2
    assert sequence.groundtruth is not None
    assert len(sequence.groundtruth) == 4


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["no_such_plan"], "no_such_plan"),
        (["/nonexistent/plan.json"], "/nonexistent/plan.json"),
        (["one_room", "--noise", "loud"], "noise must be one of"),
        (["one_room", "--image-format", "gif"], "image_format must be jpg or png"),
        (["one_room", "--seed", "-1"], "seed must lie in"),
    ],
)
def test_mistakes_are_one_line(tmp_path: Path, vsgraphs: Program, options: list[str], message: str) -> None:
    done = vsgraphs("simulate", *options, "--out", tmp_path / "room", "--frames", 2)
    assert message in one_line_error(done)
    assert not (tmp_path / "room").exists()


def test_a_full_folder_is_not_touched(tmp_path: Path, vsgraphs: Program) -> None:
    (tmp_path / "precious.txt").write_text("precious")
    done = vsgraphs("simulate", "one_room", "--out", tmp_path, "--frames", 2, "--overwrite")
    assert "is not empty" in one_line_error(done)
    assert [path.name for path in tmp_path.iterdir()] == ["precious.txt"]


def test_a_generated_building(tmp_path: Path, vsgraphs: Program) -> None:
    options = ["--building", "line", "--rooms", 2, "--furnishings", 1, "--frames", 1, "--labels-every", 0]
    done = vsgraphs("simulate", *options, "--seed", 5, "--out", tmp_path / "a")
    assert done.returncode == 0, done.stderr
    plan = tmp_path / "a" / "plan.json"
    assert json.loads(plan.read_text()) == building("line", 2, 1, seed=5)
    truth = json.loads((tmp_path / "a" / "scene_gt.json").read_text())
    assert (truth["plan"], truth["noise_seed"], len(truth["rooms"])) == ("line-2-1-5", 5, 3)
    # The plan beside it renders the same; the draw of the noise can be chosen alone.
    done = vsgraphs("simulate", plan, *options[6:], "--seed", 5, "--out", tmp_path / "b")
    assert done.returncode == 0, done.stderr
    done = vsgraphs("simulate", *options, "--seed", 5, "--noise-seed", 6, "--out", tmp_path / "c")
    assert done.returncode == 0, done.stderr
    a, b, c = (next((tmp_path / name / "depth").iterdir()).read_bytes() for name in "abc")
    assert a == b
    assert a != c
    truth = json.loads((tmp_path / "c" / "scene_gt.json").read_text())
    assert (truth["seed"], truth["noise_seed"]) == (5, 6)


def test_plans_alone(tmp_path: Path, vsgraphs: Program) -> None:
    file = tmp_path / "ring.json"
    done = vsgraphs("simulate", "--building", "ring", "--plan-only", file)
    assert done.returncode == 0, done.stderr
    assert json.loads(file.read_text()) == building("ring", 12, 4, seed=0)
    assert "exists" in one_line_error(vsgraphs("simulate", "two_rooms", "--plan-only", file))
    done = vsgraphs("simulate", "two_rooms", "--plan-only", file, "--overwrite")
    assert done.returncode == 0, done.stderr
    assert json.loads(file.read_text())["name"] == "two_rooms"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ([], "give a PLAN (a name or a file), or --building KIND"),
        (["one_room"], "--out DIR is missing"),
        (
            ["one_room", "--building", "line", "--out", "x"],
            "give either the plan one_room or --building line",
        ),
        (["--building", "lien", "--out", "x"], "building must be one of line, ring, star, storeys"),
        (["--building", "line", "--rooms", "0", "--out", "x"], "rooms must be a whole number from 1 to 200"),
        (["one_room", "--furnishings", "3", "--out", "x"], "--furnishings goes with --building"),
        (["--building", "line", "--storeys", "3", "--out", "x"], "--storeys goes with --building storeys"),
        (["--building", "line", "--plan-only", "p.json", "--out", "x"], "leave --out away"),
        (["--building", "line", "--plan-only", "no/p.json"], "cannot write no/p.json"),
        (["no_such_plan", "--plan-only", "p.json"], "no_such_plan"),
    ],
)
def test_mistakes_in_choosing_a_plan(
    tmp_path: Path, vsgraphs: Program, options: list[str], message: str
) -> None:
    assert message in one_line_error(vsgraphs("simulate", *options, cwd=tmp_path))
    assert list(tmp_path.iterdir()) == []


def test_a_second_program_is_kept_from_the_same_folder(tmp_path: Path, vsgraphs: Program) -> None:
    out = tmp_path / "out"
    with Locks(print) as locks:
        locks.hold_file(out)
        error = one_line_error(vsgraphs("simulate", "demo", "--out", out, "--frames", 2))
        assert "another vsgraphs writes there" in error
    assert not out.exists()
    making = FolderInTheMaking(out, overwrite=False)
    with making:
        (making.path / "mine").touch()
        out.mkdir()
        (out / "another's").touch()
        with pytest.raises(InputError, match="is not empty"):
            making.keep()
    assert [path.name for path in out.iterdir()] == ["another's"]
