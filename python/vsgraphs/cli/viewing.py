"""Showing a run (`run --view`, `run --record`) and opening a finished one (`vsgraphs view`)."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vsgraphs.cli.interrupt import Interrupt

if TYPE_CHECKING:
    from vsgraphs.datasets import Calibration
    from vsgraphs.view import LiveView, SinkRequest, Sinks

_ARRIVE_S = 60.0  # a finished run, in the viewer: nothing else waits


@dataclass(frozen=True)
class Showing:
    """What the user asked for; `request` loads what shows it."""

    view: bool = False
    record: Path | None = None
    port: int | None = None
    web: bool = False
    address: str | None = None

    @property
    def wanted(self) -> bool:
        """Whether anything is to be shown."""
        return self.view or self.web or self.record is not None

    def request(self) -> SinkRequest:
        """For `vsgraphs.view.open_sinks`."""
        from vsgraphs.view import DEFAULT_ADDRESS, DEFAULT_PORT, SinkRequest

        port = DEFAULT_PORT if self.port is None else self.port
        address = DEFAULT_ADDRESS if self.address is None else self.address
        return SinkRequest(self.view or self.web, self.record, port, self.web, address)


class RunView:
    """A run's view, or nothing where none was asked for. Opening it raises InputError."""

    def __init__(self, showing: Showing) -> None:
        self._sinks: Sinks | None = None
        self._live: LiveView | None = None
        self._tell: Callable[[str], None] = lambda line: print(line, file=sys.stderr, flush=True)
        if showing.wanted:
            from vsgraphs.view import open_sinks

            self._sinks = open_sinks(showing.request(), self._say)

    def _say(self, line: str) -> None:
        self._tell(line)  # which changes when there is a progress line

    def watch(
        self, tracker: Any, slam: Any, camera: Calibration, mode: str, tell: Callable[[str], None]
    ) -> Any:
        """The tracker, watched; the tracker itself where there is no view. tell: from now on."""
        self._tell = tell
        if self._sinks is None:
            return tracker
        from vsgraphs.view import LiveView

        self._live = LiveView(slam, camera, self._sinks, with_planes=mode != "slam", tell=self._say)
        return self._live.watch(tracker)

    def close(self) -> None:
        """Shows the result. Never raises."""
        if self._live is not None:
            self._live.close()

    def linger(self, out: Path) -> None:
        """A page for browsers lives as long as this program: waits for Ctrl-C where somebody can press it."""
        if self._sinks is None or self._sinks.page is None:
            return
        if sys.stdin.isatty():
            wait_with_page(self._sinks)
        else:
            print(f"the viewer's page ends with this program; `vsgraphs view {out} --web` opens the result")
        self._sinks.end()

    def report(self) -> dict[str, Any] | None:
        """For run.json; None without a view."""
        return None if self._live is None else self._live.report()

    @property
    def warnings(self) -> list[str]:
        """What went wrong with the view."""
        kept = self._sinks.troubles if self._sinks is not None else []
        return kept + (self._live.warnings if self._live is not None else [])


def wait_with_page(sinks: Sinks) -> None:
    """Until Ctrl-C, or until the server has ended."""
    print(f"the viewer stays open at {sinks.page} until Ctrl-C", flush=True)
    with Interrupt() as interrupt:
        while not interrupt.requested() and sinks.page is not None:
            time.sleep(0.1)
    if sinks.page is None:
        print("warning: the viewer's server has ended", file=sys.stderr, flush=True)


def view_run(folder: Path, showing: Showing) -> None:
    """`vsgraphs view`: opens a finished run. Raises InputError."""
    from vsgraphs.view import check_run, open_sinks, show_run

    check_run(folder)  # before a window opens
    sinks = open_sinks(showing.request(), lambda line: print(line, flush=True))
    show_run(folder, sinks)
    sinks.close(_ARRIVE_S)
    if sinks.record is not None:
        print(f"recorded in {sinks.record}")
    if sinks.page is not None:
        wait_with_page(sinks)
    sinks.end()
