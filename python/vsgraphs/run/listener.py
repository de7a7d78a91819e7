"""Who is told how a run goes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vsgraphs.run.session import Tally

_WARNING = "warning: "


class Listener:
    """Is told how a run goes, and does nothing about it: for others to override.

    Lines are complete sentences or parts of one, without a line feed. `event` may be called from any thread,
    all else from the run's. Once `failure` is set the run ends as when it is told to stop, and raises it.
    """

    failure: Exception | None = None

    def note(self, line: str) -> None:
        """What was opened, loaded or saved."""

    def event(self, line: str) -> None:
        """Something worth a line happened; one that begins with "warning: " is meant as such."""

    def begin(self, total: int | None) -> None:
        """Tracking begins. total: of the frames to come, None where nobody knows."""

    def frame(self, tally: Tally, status: str) -> None:
        """A frame was dealt with. status: of the last one that was tracked."""

    def doing(self, what: str) -> None:
        """What goes on once there are no more frames."""


@dataclass(frozen=True)
class Progress:
    """How far a run is.

    seen, tracked: frames so far. total: None where nobody knows. status: of the last frame, as "ok" or
    "lost". doing: what goes on once there are no more frames, "" before.
    """

    seen: int
    tracked: int
    total: int | None
    status: str
    doing: str = ""


@dataclass(frozen=True)
class Message:
    """A line for people. kind: "note" (opened, loaded, saved), "event" (lost, skipped, ...) or "warning"."""

    text: str
    kind: str

    def __str__(self) -> str:
        return f"{_WARNING}{self.text}" if self.kind == "warning" else self.text


class Callbacks(Listener):
    """Hands on to two functions, if they are given; once one has raised an exception, no more."""

    def __init__(
        self,
        on_progress: Callable[[Progress], object] | None,
        on_message: Callable[[Message], object] | None,
    ) -> None:
        self._on_progress, self._on_message = on_progress, on_message
        self._last = Progress(0, 0, None, "")

    def note(self, line: str) -> None:
        """As a Message."""
        self._tell(Message(line, "note"))

    def event(self, line: str) -> None:
        """As a Message."""
        text = line.removeprefix(_WARNING)
        self._tell(Message(text, "event" if text == line else "warning"))

    def begin(self, total: int | None) -> None:
        """Keeps the number for what follows."""
        self._last = Progress(0, 0, total, "")

    def frame(self, tally: Tally, status: str) -> None:
        """As a Progress."""
        self._show(Progress(tally.seen, tally.tracked, self._last.total, status))

    def doing(self, what: str) -> None:
        """As the last Progress, with what goes on."""
        last = self._last
        self._show(Progress(last.seen, last.tracked, last.total, last.status, what))

    def _show(self, progress: Progress) -> None:
        self._last = progress
        if self._on_progress is not None:
            self._call(partial(self._on_progress, progress))

    def _tell(self, message: Message) -> None:
        if self._on_message is not None:
            self._call(partial(self._on_message, message))

    def _call(self, function: Callable[[], object]) -> None:
        if self.failure is None:
            try:
                function()
            except Exception as error:  # results are written first
                self.failure = error
