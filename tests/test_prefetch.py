from __future__ import annotations

import threading
import time
from pathlib import Path

import numpy as np
import pytest
from layouts import write_tum

from vsgraphs.datasets import open_sequence
from vsgraphs.errors import FrameError
from vsgraphs.sources.prefetch import Prefetcher


class SlowFrame:
    """Loads after a while; remembers how many were loaded, and by which thread."""

    loaded: list[int]

    def __init__(
        self, index: int, loaded: list[int], trouble: Exception | None = None, wait_s: float = 0
    ) -> None:
        self.timestamp = float(index)
        self.index, self.loaded, self.trouble, self.wait_s = index, loaded, trouble, wait_s
        self.thread = ""

    def load(self) -> tuple[np.ndarray, np.ndarray]:
        time.sleep(self.wait_s)
        self.thread = threading.current_thread().name
        self.loaded.append(self.index)
        if self.trouble:
            raise self.trouble
        return np.zeros((1, 1, 3), np.uint8), np.zeros((1, 1), np.uint16)


@pytest.mark.parametrize("workers", [1, 3])
def test_order_is_kept(workers: int) -> None:
    loaded: list[int] = []
    frames = [SlowFrame(i, loaded, wait_s=0.003 * (i % 3)) for i in range(30)]
    with Prefetcher(frames, ahead=5, workers=workers) as prefetcher:
        assert [frame.index for frame in prefetcher] == list(range(30))
    assert all(frame.thread.startswith("decode") for frame in frames)


def test_never_more_than_a_few_ahead() -> None:
    loaded: list[int] = []
    with Prefetcher([SlowFrame(i, loaded) for i in range(50)], ahead=4) as prefetcher:
        frames = iter(prefetcher)
        for taken in range(1, 20):
            next(frames)
            time.sleep(0.005)
            assert len(loaded) <= taken + 4
    assert len(loaded) < 50


def test_damage_comes_with_its_frame_and_other_errors_are_raised() -> None:
    loaded: list[int] = []
    frames = [SlowFrame(i, loaded) for i in range(6)]
    frames[2].trouble = FrameError("bad.png is damaged")
    frames[4].trouble = ZeroDivisionError("ours")
    seen = []
    with Prefetcher(frames) as prefetcher, pytest.raises(ZeroDivisionError):
        seen.extend(prefetcher)
    seen_errors = []
    with Prefetcher(frames[:4]) as prefetcher:
        seen_errors = [frame.error for frame in prefetcher]
    assert str(seen_errors[2]) == "bad.png is damaged"
    assert seen_errors[:2] + seen_errors[3:] == [None, None, None]


def test_closing_early_ends_the_threads() -> None:
    loaded: list[int] = []
    prefetcher = Prefetcher([SlowFrame(i, loaded, wait_s=0.01) for i in range(1000)])
    next(iter(prefetcher))
    prefetcher.close()
    assert len(loaded) < 20
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("decode")]


def test_no_frames() -> None:
    with Prefetcher([]) as prefetcher:
        assert list(prefetcher) == []


def test_damaged_files_of_a_real_folder(tmp_path: Path) -> None:
    frames = open_sequence(write_tum(tmp_path / "s")).frames
    frames[1].rgb_path.unlink()
    with Prefetcher(frames) as prefetcher:
        errors = [str(frame.error) if frame.error else "" for frame in prefetcher]
    assert "is missing" in errors[1]
    assert errors.count("") == 7
