"""The command `simulate`; what it renders is tested in test_simulate.py."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from conftest import Program, one_line_error

from vsgraphs.datasets import open_sequence


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
