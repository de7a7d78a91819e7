"""Where what is shown goes: a viewer's window, a server for browsers, a file; or several of them."""

from __future__ import annotations

import atexit
import os
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.view import ports
from vsgraphs.view.extra import rerun
from vsgraphs.view.link import Link, short
from vsgraphs.view.server import Server, who_can_look
from vsgraphs.view.window import open_window

APPLICATION = "vsgraphs"
DEFAULT_PORT = 9876
_FLUSH_S = 5.0  # a run's results wait no longer for a viewer


@dataclass(frozen=True)
class SinkRequest:
    """What the user asked for. web: serve for browsers even where there is a display."""

    view: bool = False
    record: Path | None = None
    port: int = DEFAULT_PORT  # of the viewer's window or of the data; the browser's page is one above
    web: bool = False
    address: str = ports.LOOPBACK  # where the viewer listens


@dataclass
class Sinks:
    """A recording, a viewer, or both, of the same. Not for use by several threads at once.

    window: whether the viewer is a window, not a page for browsers.
    """

    recording: Any = None
    viewer: Link | None = None
    window: bool = False
    server: Server | None = None
    record: Path | None = None
    tell: Callable[[str], None] = lambda _: None
    troubles: list[str] = field(default_factory=list)  # what was told and is worth keeping
    _announced: dict[str, set[str]] = field(default_factory=dict)

    @property
    def streams(self) -> list[Any]:
        """Those that still take something; the recording first."""
        viewer = self.viewer if self.viewer is not None and self.viewer.lost is None else None
        return [stream for stream in (self.recording, viewer) if stream is not None]

    @property
    def page(self) -> str | None:
        """The address for browsers on this machine, while it is served."""
        return self.server.page if self.server is not None and self.server.alive() else None

    def log(self, path: str, shown: Any, *, static: bool = False) -> None:
        """Logs one thing everywhere."""
        for stream in self.streams:
            stream.log(path, shown, static=static)

    def renew(self, under: str, paths: list[str]) -> None:
        """Takes away what was announced last time below `under` and is not among `paths`."""
        for gone in self._announced.get(under, set()) - set(paths):
            self.log(gone, rerun().Clear(recursive=True))
        self._announced[under] = set(paths)

    def at(self, timestamp_s: float) -> None:
        """What follows belongs to this time of the sequence."""
        for stream in self.streams:
            stream.set_time("time", duration=timestamp_s)

    def arrange(self, layout: Any) -> None:
        """Divides the window as given."""
        for stream in self.streams:
            stream.send_blueprint(layout, make_active=True, make_default=True)

    def trouble(self, line: str) -> None:
        """Tells and keeps a warning."""
        self.troubles.append(line)
        self.tell(f"warning: {line}")

    def hurry(self) -> None:
        """A viewer that does not read is given up sooner from now on."""
        if self.viewer is not None:
            self.viewer.hurry()

    def close(self, limit_s: float = _FLUSH_S) -> None:
        """Waits until all that was logged has arrived, at most that long. The page for browsers stays."""
        if self.recording is not None:
            try:
                self.recording.flush(timeout_sec=limit_s)
            except Exception as error:
                self.trouble(f"the recording is not whole: {short(error)}")
            self.recording.disconnect()
        if self.viewer is not None:
            self.viewer.flush(limit_s)

    def end(self) -> None:
        """Ends the page for browsers; a window stays. Afterwards Rerun has nobody to wait for at exit."""
        atexit.unregister(self.end)
        if self.viewer is not None and self.server is not None:
            self.viewer.cut()
        elif self.viewer is not None:
            self.hurry()
            self.viewer.flush(_FLUSH_S)
            self.viewer.leave()
        if self.server is not None:
            self.server.end()


def has_display() -> bool:
    """Whether a window could open here."""
    return sys.platform != "linux" or any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))


def open_sinks(request: SinkRequest, tell: Callable[[str], None]) -> Sinks:
    """Opens what was asked for.

    Raises InputError: extra missing, port taken, file not writable, no window, not this machine's address.
    Without a display the data is served for a browser instead, and its address told.
    """
    if request.view:
        ports.require_address(request.address)
    _quiet()
    rr = rerun()
    sinks = Sinks(tell=tell)
    if request.record is not None:
        sinks.record = request.record
        sinks.recording = _recording(rr, request.record)
    if request.view:
        _open_viewer(rr, sinks, request)
    return sinks


def _quiet() -> None:
    """Rerun's own log says on stderr what is told here in a line. Only before it is loaded."""
    os.environ.setdefault("RUST_LOG", "off")
    os.environ.setdefault("TELEMETRY_ENABLED", "false")


def _recording(rr: Any, path: Path) -> Any:
    if path.suffix != ".rrd":
        raise InputError(f"--record {path}: expected a name ending in .rrd")
    if path.is_dir() or not path.resolve().parent.is_dir():
        raise InputError(
            f"--record {path}: {path.resolve().parent} is not a directory that can be written to"
        )
    stream = rr.RecordingStream(APPLICATION, send_properties=False)
    try:
        stream.save(path)
    except Exception as error:
        raise InputError(f"--record {path}: cannot write ({short(error)})") from None
    return stream


def _open_viewer(rr: Any, sinks: Sinks, request: SinkRequest) -> None:
    where = (request.address, request.port)
    if request.web or not has_display():
        server = sinks.server = Server(*where)
        data = server.data
    else:
        server, sinks.window = None, True
        data = open_window(*where, sinks.tell)
    stream = rr.RecordingStream(APPLICATION, send_properties=False)
    stream.connect_grpc(data)

    def gone() -> str | None:
        if server is not None:
            return None if server.alive() else "the viewer's server has ended"
        return None if ports.listens(request.port, request.address) else "the viewer was closed"

    sinks.viewer = Link(stream, *where, gone, sinks.trouble)
    atexit.register(sinks.end)  # called before what Rerun has registered, which waits without a limit
    if server is not None:
        sinks.tell(f"open {server.page} in a browser{'' if request.web else ' (there is no display here)'}")
        who_can_look(*where, sinks.tell)
