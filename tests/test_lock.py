"""One program at a time writes an atlas or a folder of results."""

from __future__ import annotations

import errno
import fcntl
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from vsgraphs.errors import InputError
from vsgraphs.export.lock import Locks

HOLDER = """
import sys, time
from pathlib import Path
from vsgraphs.export.lock import Locks
with Locks(print) as locks:
    (locks.hold_folder if sys.argv[2] == "folder" else locks.hold_file)(Path(sys.argv[1]))
    print("held", flush=True)
    if sys.argv[2] == "fork":
        import os
        if os.fork() == 0:
            print("forked", flush=True)
            time.sleep(600)
    sys.stdin.read()
"""


@contextmanager
def another_program(path: Path, what: str = "file") -> Iterator[subprocess.Popen[str]]:
    """Holds the path until it is told to end or killed."""
    command = [sys.executable, "-c", HOLDER, str(path), what]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stdout.readline() == "held\n"
        try:
            yield process
        finally:
            process.kill()


def never(line: str) -> None:
    raise AssertionError(line)


def test_the_second_is_told_who_holds_it(tmp_path: Path) -> None:
    atlas = tmp_path / "house.vsg"
    with another_program(atlas) as holder, Locks(never) as locks:
        with pytest.raises(InputError) as error:
            locks.hold_file(atlas)
        assert str(error.value).startswith(f"{atlas}: another vsgraphs writes there (process {holder.pid}); ")
        holder.communicate("")
        locks.hold_file(atlas)
    assert list(tmp_path.iterdir()) == []


def test_a_killed_holder_holds_nobody_up(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    with another_program(out, "folder") as holder, Locks(never) as locks:
        with pytest.raises(InputError, match="another vsgraphs"):
            locks.hold_folder(out)
        holder.send_signal(signal.SIGKILL)
        holder.wait()
        assert (out / ".lock").exists()  # what is left of it
        locks.hold_folder(out)
        assert f"{os.getpid()} " in (out / ".lock").read_text()
    assert list(out.iterdir()) == []


def test_a_forked_child_keeps_nothing_of_a_parent_that_is_gone(tmp_path: Path) -> None:
    atlas = tmp_path / "house.vsg"
    with another_program(atlas, "fork") as holder, Locks(never) as locks:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "forked\n"
        holder.kill()
        holder.wait()
        locks.hold_file(atlas)


def test_one_file_by_two_names_is_one(tmp_path: Path) -> None:
    link = tmp_path / "link.vsg"
    (tmp_path / "elsewhere").mkdir()
    link.symlink_to(tmp_path / "elsewhere" / "house.vsg")
    with Locks(never) as locks:
        locks.hold_file(link)
        with Locks(never) as others:
            with pytest.raises(InputError, match=r"house\.vsg: another"):
                others.hold_file(tmp_path / "elsewhere" / "house.vsg")
            others.hold_file(tmp_path / "elsewhere" / "flat.vsg")
    assert list((tmp_path / "elsewhere").iterdir()) == []


def test_a_program_holds_what_it_asks_for_until_it_lets_go(tmp_path: Path) -> None:
    with Locks(never) as locks:
        locks.hold_folder(tmp_path)
        locks.hold_file(tmp_path / "atlas.vsg")
        locks.release()
        with Locks(never) as others:
            others.hold_folder(tmp_path)
            others.hold_file(tmp_path / "atlas.vsg")
            locks.release()  # nothing any more
            assert len(list(tmp_path.iterdir())) == 2


def test_a_folder_made_anew_is_somebody_elses(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    with Locks(never) as locks, Locks(never) as others:
        locks.hold_folder(out)
        out.rename(tmp_path / "moved")
        out.mkdir()
        others.hold_folder(out)
        locks.release()
        assert (out / ".lock").exists()
        with Locks(never) as third, pytest.raises(InputError, match="another vsgraphs"):
            third.hold_folder(out)


@pytest.mark.parametrize("number", [errno.ENOLCK, errno.EOPNOTSUPP])
def test_a_file_system_without_locks_is_told_and_used(
    tmp_path: Path, number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(descriptor: int, how: int) -> None:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(fcntl, "flock", refuse)
    told: list[str] = []
    with Locks(told.append) as locks:
        locks.hold_folder(tmp_path)
    assert told == [f"{tmp_path} cannot be locked ({os.strerror(number)}): let no other program write there"]


TAKER = """
import sys, time
from pathlib import Path
from vsgraphs.errors import InputError
from vsgraphs.export.lock import Locks
path, mark = Path(sys.argv[1]), Path(sys.argv[1] + ".mark")
taken = 0
end = time.monotonic() + 60
while taken < 50 and time.monotonic() < end:
    with Locks(print) as locks:
        try:
            locks.hold_file(path)
        except InputError:
            continue
        mark.touch(exist_ok=False)  # fails if another is here too
        mark.unlink()
        taken += 1
print(taken)
"""


def test_never_two_at_once(tmp_path: Path) -> None:
    """Locks are taken and removed again at the same time by several programs."""
    command = [sys.executable, "-c", TAKER, str(tmp_path / "house.vsg")]
    programs = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    assert [program.communicate(timeout=120)[0] for program in programs] == ["50\n"] * 3
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_was_made_anew_is_held_no_more(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    with Locks(print) as locks:
        locks.hold_folder(out)
        assert locks.still_holds_folder(out)
        assert locks.still_holds_folder(tmp_path)  # was never held: nothing was lost
        shutil.rmtree(out)
        assert locks.still_holds_folder(out)  # nobody else has it
        out.mkdir()
        with Locks(print) as others:
            others.hold_folder(out)
            assert not locks.still_holds_folder(out)
