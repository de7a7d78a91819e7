"""Showing a run while it goes on: in a viewer, in a page for browsers, in a recording."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from vsgraphs.view import LiveView, SinkRequest, Sinks


@dataclass(frozen=True)
class Showing:
    """Where a run is shown; `request` loads what shows it.

    view: a window, or without a display a page for a browser. web: always a page. record: an .rrd file.
    port, address: where the viewer listens, None: 9876 and this machine alone.
    """

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
        record = None if self.record is None else Path(self.record)
        return SinkRequest(self.view or self.web, record, port, self.web, address)


class RunView:
    """A run's view, or nothing where none was asked for. Opening it raises InputError.

    tell: takes lines for people, from any thread.
    """

    def __init__(self, showing: Showing, tell: Callable[[str], None] = lambda _: None) -> None:
        self.sinks: Sinks | None = None
        self._live: LiveView | None = None
        self._tell = tell
        if showing.wanted:
            from vsgraphs.view import open_sinks

            self.sinks = open_sinks(showing.request(), tell)

    def watch(self, tracker: Any, slam: Any, camera: Any, mode: str) -> Any:
        """The tracker, watched; the tracker itself where there is no view."""
        if self.sinks is None:
            return tracker
        from vsgraphs.view import LiveView

        self._live = LiveView(slam, camera, self.sinks, with_planes=mode != "slam", tell=self._tell)
        return self._live.watch(tracker)

    def close(self) -> None:
        """Shows the result. Never raises."""
        if self._live is not None:
            self._live.close()

    def report(self) -> dict[str, Any] | None:
        """For run.json; None without a view."""
        return None if self._live is None else self._live.report()

    @property
    def warnings(self) -> list[str]:
        """What went wrong with the view."""
        kept = self.sinks.troubles if self.sinks is not None else []
        return kept + (self._live.warnings if self._live is not None else [])
