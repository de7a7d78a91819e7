"""The loop over a source's frames."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from vsgraphs.errors import StalledError

if TYPE_CHECKING:
    from vsgraphs.run.listener import Listener
    from vsgraphs.sources import LoadedFrame

# Of each kind of damage this many frames are named, the rest are counted.
_NAMED_FRAMES = 5


@dataclass
class Tally:
    """What became of the frames so far."""

    seen: int = 0  # handed out by the source, in whatever state
    tracked: int = 0
    # reason -> frames: damaged, stalled (did not come in time), dropped, refused
    skipped: Counter[str] = field(default_factory=Counter)
    statuses: Counter[str] = field(default_factory=Counter)  # of the others: ok, lost, ...
    warnings: list[str] = field(default_factory=list)
    first_tracked_at: float | None = None  # time.monotonic
    decode_spans: list[tuple[int, int, int]] = field(default_factory=list)  # begin us, duration us, frame
    interrupted: bool = False


class Session:
    """Feeds frames to a tracker until they end or `stop` says so; keeps count, never the frames.

    slam: a `vsgraphs.Slam` or anything with its `track`. length: of the frames, if it is known. A frame that
    cannot be read or that the tracker refuses is skipped and counted. What is lost and found again is told to
    the listener and kept as a warning. Once `stop` says so no frame is begun; one that the tracker then hands
    back untracked was not. tracked: called with each frame's TrackResult and timestamp.
    """

    def __init__(
        self,
        slam: Any,
        frames: Iterable[LoadedFrame],
        listener: Listener,
        *,
        length: int | None = None,
        stop: Callable[[], bool] = lambda: False,
        tracked: Callable[[Any, float], object] = lambda *_: None,
    ) -> None:
        self._slam = slam
        self._frames = frames
        self._listener = listener
        self._length = length
        self._stop, self._tracked = stop, tracked
        self._status = ""
        self._lost_since: float | None = None
        self.tally = Tally()

    def run(self) -> Tally:
        """Tracks all frames; returns the count."""
        tally = self.tally
        for frame in self._frames:
            if self._stop():
                break
            tally.seen += 1
            self._note_loading(frame)
            if frame.error is not None:
                reason = "stalled" if isinstance(frame.error, StalledError) else "damaged"
                self._skip(reason, str(frame.error))
            elif frame.dropped:
                self._skip("dropped", None)
            elif not self._track(frame):
                tally.seen -= 1
                break
            self._listener.frame(tally, self._status)
        tally.interrupted = self._stop() and (self._length is None or tally.seen < self._length)
        dropped = tally.skipped["dropped"]
        if dropped:
            tally.warnings.append(f"{dropped} frames came while an earlier one was tracked, dropped")
        return tally

    def _note_loading(self, frame: LoadedFrame) -> None:
        if frame.rgb is None and frame.error is None:
            return  # a camera's frame that nobody looked at
        duration_us = int((frame.end_s - frame.begin_s) * 1e6)
        self.tally.decode_spans.append((int(frame.begin_s * 1e6), duration_us, frame.index))

    def _track(self, frame: LoadedFrame) -> bool:
        """False if the tracker passed the frame over, as it was told to stop."""
        try:
            result = self._slam.track(frame.rgb, frame.depth, frame.timestamp)
        except ValueError as error:  # the core's InputError: this frame cannot be used
            self._skip("refused", f"frame {frame.index} at {frame.timestamp:.6f} s: {error}")
            return True
        if result.tracked:
            self.tally.tracked += 1
            if self.tally.first_tracked_at is None:
                self.tally.first_tracked_at = time.monotonic()
        elif self._stop():
            return False
        self._follow(str(result.status), frame)
        self._tracked(result, frame.timestamp)
        return True

    def _follow(self, status: str, frame: LoadedFrame) -> None:
        """Counts, and tells when tracking is lost and found."""
        self._status = status
        self.tally.statuses[status] += 1
        if status == "lost" and self._lost_since is None:
            self._lost_since = frame.timestamp
            self._tell(f"lost at frame {frame.index} ({frame.timestamp:.3f} s)")
        elif status in ("ok", "relocalised", "initialised") and self._lost_since is not None:
            gone = frame.timestamp - self._lost_since
            self._lost_since = None
            found = "new map" if status == "initialised" else "relocalised"
            self._tell(f"{found} at frame {frame.index} ({frame.timestamp:.3f} s), lost for {gone:.2f} s")

    def _skip(self, reason: str, message: str | None) -> None:
        skipped = self.tally.skipped
        skipped[reason] += 1
        if message is None:
            return
        if skipped[reason] <= _NAMED_FRAMES:
            self._tell(f"skipped: {message}")
        elif skipped[reason] == _NAMED_FRAMES + 1:
            self._tell(f"more {reason} frames follow, counted but not named")

    def _tell(self, line: str) -> None:
        self.tally.warnings.append(line)
        self._listener.event(line)
