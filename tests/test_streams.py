"""Standard streams that are closed, full or read by nobody; and what little memory is told as."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import Program, one_line_error, report

from vsgraphs.cli.failures import told
from vsgraphs.errors import InputError


@pytest.mark.parametrize("closed", [(2,), (0, 1, 2)])
def test_a_run_with_closed_streams(
    closed: tuple[int, ...], recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    def close() -> None:
        for number in closed:
            os.close(number)

    out = tmp_path / "out"
    done = vsgraphs("run", recorded, "--out", out, "--max-frames", 8, preexec_fn=close)
    assert done.returncode == 0, done.stderr
    assert report(out)["tracked"] == 8
    for path in out.iterdir():  # nothing was said into a file
        assert b"tracked 8 of 8" not in path.read_bytes()
        assert b"TUM RGB-D sequence" not in path.read_bytes()


@pytest.mark.parametrize("closed", [1, 2])
def test_mistakes_with_closed_streams(closed: int, tmp_path: Path, vsgraphs: Program) -> None:
    done = vsgraphs("run", tmp_path / "no", "--out", tmp_path / "out", preexec_fn=lambda: os.close(closed))
    assert done.returncode == 2
    assert "Traceback" not in done.stderr


def test_nobody_reads_the_errors(recorded: Path, tmp_path: Path) -> None:
    read_end, write_end = os.pipe()
    os.close(read_end)
    command = [
        sys.executable,
        "-m",
        "vsgraphs",
        "run",
        recorded,
        "--out",
        tmp_path / "out",
        "--max-frames",
        "8",
    ]
    for stderr in (write_end, os.open("/dev/full", os.O_WRONLY)):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=stderr, check=False, timeout=120)
        os.close(stderr)
        assert done.returncode == 0
        assert report(tmp_path / "out")["tracked"] == 8


@pytest.mark.parametrize("arguments", [["config", "--yaml"], ["--help"]])
def test_a_full_output_is_told(arguments: list[str]) -> None:
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run(
            [sys.executable, "-m", "vsgraphs", *arguments],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
            timeout=120,
        )
    assert done.returncode in (1, 2)
    assert "Traceback" not in done.stderr
    assert "Exception ignored" not in done.stderr
    assert "No space left on device" in done.stderr


def test_names_that_are_no_text_can_be_printed(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    folder = Path(os.fsdecode(os.fsencode(tmp_path) + b"/caf\xe9\n"))
    folder.symlink_to(recorded)
    out = Path(os.fsdecode(os.fsencode(tmp_path) + b"/out\xff"))
    done = vsgraphs(
        "run", folder, "--out", out, "--max-frames", 8, "--schedule-out", tmp_path / "s", env={**os.environ}
    )
    assert done.returncode == 0, done.stderr
    assert report(out)["tracked"] == 8
    strange = Path(os.fsdecode(os.fsencode(tmp_path) + b"/s\xff"))
    error = one_line_error(vsgraphs("run", recorded, "--out", out, "--replay", strange))
    assert "no text (UTF-8)" in error


def exit_of(error: Exception, capsys: pytest.CaptureFixture[str]) -> tuple[object, str]:
    with pytest.raises(SystemExit) as ended, told():
        raise error
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    return ended.value.code, said


def test_want_of_memory_is_told_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    for error in (MemoryError(), MemoryError("std::bad_alloc"), RuntimeError("can't start new thread")):
        code, said = exit_of(error, capsys)
        assert code == 2
        assert said.startswith("error: not enough memory: ")


def test_too_little_memory_to_begin(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (80 << 20, 80 << 20))  # numpy does not fit

    done = vsgraphs("run", recorded, "--out", tmp_path / "out", "--max-frames", 8, preexec_fn=limit)
    assert "not enough memory" in one_line_error(done)


def test_whatever_an_error_holds_it_is_one_line_and_not_a_page(capsys: pytest.CaptureFixture[str]) -> None:
    for error in (
        InputError("a\nb" + "x" * 10**6),
        OSError(36, "File name too long", "y" * 10**5),
        ImportError("first\n\n  second" * 1000),
        ZeroDivisionError("z" * 10**6),
    ):
        _, said = exit_of(error, capsys)
        assert len(said) < 1000
