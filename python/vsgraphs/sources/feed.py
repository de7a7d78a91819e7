"""Frames on their way from a source to the tracker."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import islice
from typing import Protocol

from vsgraphs.sources.loaded import LoadedFrame
from vsgraphs.sources.newest import Newest
from vsgraphs.sources.prefetch import DEFAULT_LIMIT_S, Prefetcher
from vsgraphs.sources.source import Frame, Source


class Feed(Protocol):
    """Loaded frames in order, from entering the context until it is left."""

    def __enter__(self) -> Feed: ...

    def __exit__(self, *exc: object) -> None: ...

    def __iter__(self) -> Iterator[LoadedFrame]: ...

    def stop(self) -> None:
        """Ends the iteration, also one that waits for a frame. Any thread."""
        ...

    def close(self) -> None:
        """Stops, and lets the source go."""
        ...


def feed_of(
    source: Source,
    *,
    live: bool,
    every: int = 1,
    most: int | None = None,
    limit_s: float = DEFAULT_LIMIT_S,
    stopped: Callable[[], bool] = lambda: False,
) -> Feed:
    """Of a live source the newest frame each time; else all frames, loaded ahead.

    every, most: see `thinned`. limit_s: how long a recorded frame may take to load. stopped: see `Newest`.
    """
    frames = thinned(source.frames, every, most)
    return Newest(frames, stopped) if live else Prefetcher(frames, limit_s=limit_s)


def thinned(frames: Iterable[Frame], every: int = 1, most: int | None = None) -> Iterator[Frame]:
    """Each `every`-th frame from the first on, at most so many. Closes the source's iterator in the end."""
    iterator = iter(frames)
    try:
        yield from islice(iterator, 0, None if most is None else (most - 1) * every + 1, every)
    finally:
        close = getattr(iterator, "close", None)
        if close is not None:
            close()


def thinned_length(length: int | None, every: int = 1, most: int | None = None) -> int | None:
    """How many frames `thinned` leaves of so many; None where nobody knows."""
    if length is None:
        return None
    left = -(-length // every)
    return left if most is None else min(left, most)
