"""Frames that know when the next one was taken."""

from __future__ import annotations

from collections.abc import Generator, Iterable

from vsgraphs.sources.source import Frame


def with_following(frames: Iterable[Frame]) -> Generator[tuple[Frame, float | None]]:
    """Each frame with the next one's timestamp; what the source raises comes after its last frame."""
    iterator, before, trouble = iter(frames), None, None
    try:
        while True:
            try:
                frame = next(iterator, None)
            except Exception as error:
                frame, trouble = None, error
            if before is not None:
                yield before, None if frame is None else frame.timestamp
            if frame is None:
                break
            before = frame
    finally:
        close = getattr(iterator, "close", None)
        if close is not None:
            close()
    if trouble is not None:
        raise trouble
