from __future__ import annotations

import io
import json
import os
import time
from pathlib import Path

import numpy as np
import pytest

from vsgraphs.cli.progress import Progress
from vsgraphs.errors import InputError
from vsgraphs.export.atomic import prepare_directory, write_atomically
from vsgraphs.export.ply import format_ply
from vsgraphs.export.timeline import format_timeline
from vsgraphs.run import measures
from vsgraphs.run.session import Tally


def test_a_failed_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.txt"
    write_atomically(path, "old")

    def full(descriptor: int) -> None:
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(InputError, match=r"cannot write .*a\.txt: No space left on device"):
        write_atomically(path, "new")
    assert path.read_text() == "old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.txt"]


def test_a_link_is_followed_and_stays(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    link, real = tmp_path / "link.txt", tmp_path / "elsewhere" / "real.txt"
    link.symlink_to("elsewhere/real.txt")  # to nothing yet
    for content in ("made where the link led", "new"):
        write_atomically(link, content)
        assert real.read_text() == content
    assert link.is_symlink()
    assert [entry.name for entry in real.parent.iterdir()] == ["real.txt"]
    (tmp_path / "a").symlink_to("b")
    (tmp_path / "b").symlink_to("a")
    for path in (tmp_path / "a", Path("/dev/full"), tmp_path):
        with pytest.raises(InputError, match=f"cannot write {path}: "):
            write_atomically(path, "x")


def test_directories(tmp_path: Path) -> None:
    prepare_directory(tmp_path / "a" / "b")
    assert list((tmp_path / "a" / "b").iterdir()) == []
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="is a file; give a directory"):
        prepare_directory(tmp_path / "file")
    with pytest.raises(InputError, match="cannot create output directory"):
        prepare_directory(tmp_path / "file" / "below")
    with pytest.raises(InputError, match="is not writable"):
        prepare_directory(Path("/proc/self"))


def test_ply() -> None:
    positions = np.array([[1.5, -2.0, 3.25], [0, 0, 1e-3]])
    data = format_ply(positions, np.array([[255, 0, 7], [1, 2, 3]], np.uint8))
    header, _, body = data.partition(b"end_header\n")
    assert header.startswith(b"ply\nformat binary_little_endian 1.0\nelement vertex 2\n")
    assert len(body) == 2 * 15
    assert np.frombuffer(body[:12], "<f4").tolist() == [1.5, -2.0, 3.25]
    assert list(body[12:15]) == [255, 0, 7]
    assert format_ply(np.zeros((0, 3)), np.zeros((0, 3), np.uint8)).endswith(b"end_header\n")


def test_timeline() -> None:
    spans = [
        ("mapping", "solve", 2_000, 50, 4),
        ("tracking", "track", 1_000, 30, 3),
        ("tracking", "orb", 1_000, 9, 3),
    ]
    events = json.loads(format_timeline(spans))["traceEvents"]
    named = {event["tid"]: event["args"]["name"] for event in events if event["name"] == "thread_name"}
    work = [
        (named[e["tid"]], e["name"], e["ts"], e["dur"], e["args"]["frame"]) for e in events if e["ph"] == "X"
    ]
    assert work == [
        ("tracking", "track", 0, 30, 3),
        ("tracking", "orb", 0, 9, 3),
        ("mapping", "solve", 1000, 50, 4),
    ]
    assert json.loads(format_timeline([]))["traceEvents"]


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(("stream", "lines"), [(Terminal(), 0), (io.StringIO(), 3)])
def test_progress(stream: io.StringIO, lines: int) -> None:
    now = [0.0]
    progress = Progress(100, stream, lambda: now[0])
    tally = Tally()
    for _ in range(80):
        now[0] += 0.2
        tally.seen += 1
        progress.frame(tally, "ok")
    progress.clear()
    text = stream.getvalue()
    assert text.count("\n") == lines
    assert "5 frames/s" in text
    assert "ok" in text
    assert ("80/100" if lines == 0 else "77/100") in text
    assert f"{4 if lines == 0 else 5} s left" in text
    assert text.endswith("\r\x1b[K") == (lines == 0)


def test_a_closed_terminal_does_not_end_the_run() -> None:
    stream = io.StringIO()
    progress = Progress(10, stream, iter(range(0, 1000, 10)).__next__)
    stream.close()
    progress.frame(Tally(seen=3), "ok")
    progress.event("lost")


def test_measures() -> None:
    started = measures.process_start()
    assert 0 < time.monotonic() - started < 24 * 3600
    before = measures.cpu_s()
    sum(i * i for i in range(300_000))
    assert measures.cpu_s() > before
    assert measures.peak_memory_mb() > 10
