"""Where what is shown goes: a viewer's window, a server for browsers, a file; or several of them."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.view import ports
from vsgraphs.view.extra import rerun

APPLICATION = "vsgraphs"
DEFAULT_PORT = 9876
_SERVER_MEMORY = "1GiB"  # of what a browser that comes late still gets; the oldest goes first
_FLUSH_S = 3.0
_START_S = 20.0
_SETTLE_S = 0.5


@dataclass(frozen=True)
class SinkRequest:
    """What the user asked for. web: serve for browsers even where there is a display."""

    view: bool = False
    record: Path | None = None
    port: int = DEFAULT_PORT  # of the viewer's window or of the data; the browser's page is one above
    web: bool = False


@dataclass
class Sinks:
    """One or more recordings of the same. Not for use by several threads at once.

    window_port: where a viewer's window listens; None: none is open. page: the address for browsers.
    """

    streams: list[Any] = field(default_factory=list)
    window: Any = None
    window_port: int | None = None
    page: str | None = None
    record: Path | None = None
    tell: Callable[[str], None] = lambda _: None
    troubles: list[str] = field(default_factory=list)  # what was told and is worth keeping
    _announced: dict[str, set[str]] = field(default_factory=dict)

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

    def check_window(self) -> None:
        """Lets go of a viewer's window that was closed; what else is open goes on."""
        if self.window is None or self.window_port is None or ports.listens(self.window_port):
            return
        self.streams.remove(self.window)
        with contextlib.suppress(Exception):  # whatever it still holds has nowhere to go
            self.window.disconnect()
        self.window = self.window_port = None
        self._trouble("the viewer was closed; the run goes on without it")

    def _trouble(self, line: str) -> None:
        self.troubles.append(line)
        self.tell(line)

    def close(self) -> None:
        """Waits a few seconds until all that was logged has arrived."""
        self.check_window()
        for stream in self.streams:
            try:
                stream.flush(timeout_sec=_FLUSH_S)
            except Exception as error:
                self._trouble(f"the viewer did not take everything: {' '.join(str(error).split())[:120]}")
            if stream is not self.window and self.page is None:
                stream.disconnect()


def has_display() -> bool:
    """Whether a window could open here."""
    return sys.platform != "linux" or any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))


def open_sinks(request: SinkRequest, tell: Callable[[str], None]) -> Sinks:
    """Opens what was asked for. Raises InputError: extra missing, port taken, file not writable, no window.

    Without a display the data is served for a browser instead, and its address told.
    """
    _quiet()
    rr = rerun()
    sinks = Sinks(tell=tell)
    if request.record is not None:
        sinks.record = request.record
        sinks.streams.append(_recording(rr, request.record))
    if request.view:
        stream = rr.RecordingStream(APPLICATION, send_properties=False)
        if request.web or not has_display():
            sinks.page = _serve(rr, stream, request)
            tell(f"open {sinks.page} in a browser{'' if request.web else ' (there is no display here)'}")
        else:
            _open_window(stream, request.port, tell)
            sinks.window, sinks.window_port = stream, request.port
        sinks.streams.append(stream)
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
        raise InputError(f"--record {path}: cannot write ({_short(error)})") from None
    return stream


def _serve(rr: Any, stream: Any, request: SinkRequest) -> str:
    ports.require_free(request.port, "the viewer's data", "--view-port")
    ports.require_free(request.port + 1, "the viewer's page", "--view-port")
    try:
        url = stream.serve_grpc(grpc_port=request.port, server_memory_limit=_SERVER_MEMORY)
        rr.serve_web_viewer(web_port=request.port + 1, open_browser=False)
    except Exception as error:
        raise InputError(f"cannot serve the viewer on port {request.port}: {_short(error)}") from None
    return page_address(request.port + 1, url)


def page_address(page_port: int, data_url: str) -> str:
    """The address of the web viewer that shows the data served at `data_url`."""
    return f"http://127.0.0.1:{page_port}/?url={data_url.replace('+', '%2B')}"


def _open_window(stream: Any, port: int, tell: Callable[[str], None]) -> None:
    if not ports.is_free(port):
        if not ports.speaks_http2(port):
            ports.require_free(port, "the viewer's data", "--view-port")
        tell(f"showing in the viewer that is already open on port {port}")
        stream.connect_grpc(_address(port))
        return
    ports.require_free(port, "the viewer's data", "--view-port")
    viewer = subprocess.Popen(  # lives on after the run, and says nothing on our terminal
        [sys.executable, "-m", "rerun", "--port", str(port), "--hide-welcome-screen"],
        env={**os.environ, "RERUN_APP_ONLY": "true"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    deadline = time.monotonic() + _START_S
    while not ports.listens(port) and viewer.poll() is None and time.monotonic() < deadline:
        time.sleep(0.1)
    time.sleep(_SETTLE_S)  # without a usable display it listens for a moment, then ends
    if viewer.poll() is not None or not ports.listens(port):
        with contextlib.suppress(OSError):
            os.killpg(viewer.pid, signal.SIGTERM)  # its own group: the program behind it too
        raise InputError(
            "the viewer's window does not open (is the display usable?); --web shows it in a browser"
        )
    stream.connect_grpc(_address(port))


def _address(port: int) -> str:
    return f"rerun+http://127.0.0.1:{port}/proxy"


def _short(error: Exception) -> str:
    return " ".join(str(error).split())[:160]
