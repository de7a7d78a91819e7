"""Images that never come: names that stand for no file, disks that do not answer."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading
import time
from itertools import count
from pathlib import Path

import numpy as np
import pytest
from conftest import Program, report
from fake_core import Slam

from vsgraphs.datasets import open_sequence
from vsgraphs.datasets.decode import image_size, load_depth, load_rgb
from vsgraphs.errors import FrameError, InputError, RunError, StalledError
from vsgraphs.reading import open_regular
from vsgraphs.run.session import Session, Tally
from vsgraphs.segment.label_folder import _load as load_labels
from vsgraphs.sources import prefetch
from vsgraphs.sources.prefetch import MOST_STUCK, Prefetcher


def no_file(kind: str, path: Path) -> Path:
    if kind == "a pipe":
        os.mkfifo(path)
    elif kind == "a socket":
        socket.socket(socket.AF_UNIX).bind(str(path))
    elif kind == "a device":
        path.symlink_to("/dev/zero")
    else:
        path.mkdir()
    return path


@pytest.mark.parametrize("kind", ["a pipe", "a socket", "a device", "a folder"])
def test_only_regular_files_are_images(tmp_path: Path, kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # names of sockets are short
    path = no_file(kind, Path("image.png"))
    for load in (
        lambda: load_rgb(path, (4, 4)),
        lambda: load_depth(path, (4, 4)),
        lambda: image_size(path),
        lambda: load_labels(path),
    ):
        with pytest.raises(FrameError, match=f"image.png: it is {kind}"):
            load()


def test_regular_files_and_links_to_them_are_opened(tmp_path: Path) -> None:
    path, link = tmp_path / "a", tmp_path / "b"
    path.write_bytes(b"content")
    link.symlink_to(path)
    for name in (path, link):
        with open_regular(name, "image") as file:
            assert file.read() == b"content"
    with pytest.raises(InputError, match="No such file"):
        open_regular(tmp_path / "c", "image")


def test_a_pipe_among_the_images_is_skipped(sequence: Path, tmp_path: Path, vsgraphs: Program) -> None:
    depth = open_sequence(sequence).frames[5].depth_path
    depth.unlink()
    os.mkfifo(depth)
    done = vsgraphs("run", sequence, "--out", tmp_path / "out", "--max-frames", 12, timeout=120)
    assert done.returncode == 0, done.stderr
    assert f"skipped: cannot read image {depth}: it is a pipe" in done.stderr
    run = report(tmp_path / "out")
    assert (run["frames"], run["tracked"], run["skipped"]) == (12, 11, {"damaged": 1})


class Frame:
    """Loads at once, or when it is let."""

    def __init__(self, index: int, *, stuck: bool = False, after_s: float = 0.0) -> None:
        self.timestamp, self.after_s = float(index), after_s
        self.files = (Path(f"rgb/{index}.png"), Path(f"depth/{index}.png"))
        self.let = threading.Event()
        if not stuck:
            self.let.set()

    def load(self) -> tuple[np.ndarray, np.ndarray]:
        time.sleep(self.after_s)
        self.let.wait(30.0)
        return np.zeros((1, 1, 3), np.uint8), np.zeros((1, 1), np.uint16)


def frames(number: int, stuck: tuple[int, ...]) -> list[Frame]:
    return [Frame(index, stuck=index in stuck) for index in range(number)]


def test_a_frame_that_does_not_come_is_left_behind() -> None:
    made = frames(8, stuck=(2, 5))
    with Prefetcher(made, limit_s=0.2) as loaded:
        errors = [frame.error for frame in loaded]
    assert [type(error) for error in errors] == [
        StalledError if index in (2, 5) else type(None) for index in range(8)
    ]
    assert str(errors[2]) == "rgb/2.png or depth/2.png: no answer within 0.2 s"


def test_the_limit_counts_waiting_not_the_time_a_program_was_suspended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = frames(3, stuck=())
    made[1].after_s = 0.25
    leaps = count(step=1000)
    monkeypatch.setattr(prefetch.time, "monotonic", lambda: float(next(leaps)))
    with Prefetcher(made, limit_s=2.0) as loaded:
        assert [frame.error for frame in loaded] == [None] * 3


def test_too_many_that_do_not_come_end_the_run() -> None:
    made = frames(20, stuck=tuple(range(2, 20)))
    seen = []
    began = time.monotonic()
    with Prefetcher(made, limit_s=0.1) as loaded, pytest.raises(RunError, match=r"rgb/5\.png .* disk stalls"):
        seen.extend(loaded)
    assert time.monotonic() - began < 10
    assert [frame.index for frame in seen] == list(range(2 + MOST_STUCK))


def test_threads_that_come_back_are_no_longer_stuck() -> None:
    made = frames(12, stuck=tuple(range(1, 12)))
    seen = 0
    with Prefetcher(made, limit_s=0.1) as loaded:
        for frame in loaded:
            seen += 1
            made[frame.index].let.set()
            time.sleep(0.02)
    assert seen == 12


def test_stopping_ends_the_waiting() -> None:
    loaded = Prefetcher(frames(3, stuck=(1,)), limit_s=60.0)
    threading.Timer(0.2, loaded.stop).start()
    began = time.monotonic()
    assert [frame.index for frame in loaded] == [0]
    loaded.close()
    assert time.monotonic() - began < 10


class Silent:
    def frame(self, tally: Tally, status: str) -> None: ...

    def event(self, line: str) -> None: ...


def test_stalled_frames_are_counted_by_themselves() -> None:
    made = frames(6, stuck=(3,))
    with Prefetcher(made, limit_s=0.1) as loaded:
        tally = Session(Slam(), loaded, Silent()).run()
    assert (tally.seen, tally.tracked, dict(tally.skipped)) == (6, 5, {"stalled": 1})
    assert tally.warnings == ["skipped: rgb/3.png or depth/3.png: no answer within 0.1 s"]


def stalling(names: tuple[str, ...], *arguments: object) -> subprocess.CompletedProcess[str]:
    """The program, where depth images of these names never come."""
    script = (
        "import sys, threading\n"
        "import vsgraphs.datasets.decode as decode\n"
        "load = decode.load_depth\n"
        f"names = {names!r}\n"
        "def stalled(path, size):\n"
        "    if path.name in names:\n"
        "        threading.Event().wait()\n"
        "    return load(path, size)\n"
        "decode.load_depth = stalled\n"
        "from vsgraphs.cli import main\n"
        "main()\n"
    )
    command = [sys.executable, "-c", script, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)


def test_the_program_goes_on_and_ends_although_a_thread_is_stuck(recorded: Path, tmp_path: Path) -> None:
    names = tuple(frame.depth_path.name for frame in open_sequence(recorded).frames)
    done = stalling(
        (names[4],),
        *("run", recorded, "--out", tmp_path, "--max-frames", 12, "--frame-timeout", 0.3),
    )
    assert done.returncode == 0, done.stderr
    assert "no answer within 0.3 s" in done.stderr
    run = report(tmp_path)
    assert (run["frames"], run["tracked"], run["skipped"]) == (12, 11, {"stalled": 1})


def test_a_disk_that_stalls_for_good_ends_the_run_with_its_results(recorded: Path, tmp_path: Path) -> None:
    names = tuple(frame.depth_path.name for frame in open_sequence(recorded).frames)
    done = stalling(names[6:], "run", recorded, "--out", tmp_path, "--frame-timeout", 0.3)
    assert done.returncode == 2, done.stderr
    last = done.stderr.splitlines()[-1]
    assert last.startswith("error: ")
    assert "the disk stalls, so the run ends at frame 9" in last
    assert "Traceback" not in done.stderr
    run = report(tmp_path)
    assert (run["tracked"], run["skipped"]) == (6, {"stalled": 3})
