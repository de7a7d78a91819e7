"""The way to a viewer: addresses, ports, and a connection that holds nobody up."""

from __future__ import annotations

import itertools
import socket
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from vsgraphs.cli import viewing
from vsgraphs.cli.viewing import wait_with_page
from vsgraphs.datasets import Calibration
from vsgraphs.errors import InputError
from vsgraphs.run.watching import RunView, Showing
from vsgraphs.view import LiveView, link, live, ports, server
from vsgraphs.view.link import Link
from vsgraphs.view.sinks import Sinks

HERE = "127.0.0.1"
EVERYWHERE = "0.0.0.0"  # noqa: S104  (nothing is bound there)


@pytest.fixture
def listener() -> Iterator[int]:
    """A server that answers nothing a viewer would."""
    listening = socket.create_server((HERE, 0))

    def serve() -> None:
        while True:
            try:
                connection, _ = listening.accept()
            except OSError:
                return
            with connection:
                connection.recv(64)
                connection.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")

    threading.Thread(target=serve, daemon=True).start()
    yield listening.getsockname()[1]
    listening.close()


def test_ports(listener: int) -> None:
    assert not ports.is_free(listener, HERE)
    assert not ports.is_free(listener, EVERYWHERE)
    assert ports.is_free(listener, "127.0.0.2")
    assert ports.listens(listener, HERE)
    assert ports.listens(listener, EVERYWHERE)  # reached through loopback
    assert not ports.listens(listener, "127.0.0.2")
    assert not ports.speaks_http2(listener, HERE)
    taken = rf"port {listener} \(data\) is taken .* choose another with --view-port"
    with pytest.raises(InputError, match=taken):
        ports.require_free(listener, HERE, "data", "--view-port")
    with pytest.raises(InputError, match="--view-port 70000: a port is a number from 1 to 65535"):
        ports.require_free(70000, HERE, "data", "--view-port")


@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("kitchen", "must be an IP address of this machine, as 127.0.0.1 .only this machine can look. or"),
        ("", "must be an IP address of this machine"),
        ("127.0.0.1:9876", "must be an IP address of this machine"),
        ("fe80::1%eth0", "must be an IP address of this machine"),
        ("192.0.2.77", "this machine has no such address"),  # reserved for documentation
    ],
)
def test_addresses_that_cannot_be(address: str, message: str) -> None:
    with pytest.raises(InputError, match=f"^--view-address {address}: {message}"):
        RunView(Showing(web=True, address=address))
    with pytest.raises(InputError, match=message):
        RunView(Showing(view=True, address=address))


def test_only_an_address_that_others_reach_is_told() -> None:
    told: list[str] = []
    for address in (HERE, "127.0.0.2", "::1"):
        server.who_can_look(address, 9876, told.append)
    assert told == []
    for address, named in ((EVERYWHERE, EVERYWHERE), ("192.0.2.77", "192.0.2.77"), ("::", "[::]")):
        server.who_can_look(address, 9876, told.append)
        assert told.pop() == (
            f"warning: anybody who reaches {named}:9876 can see the camera's images and write into the view; "
            "there is no password"
        )


def test_loopback_is_asked_for_and_only_the_page_may_fetch() -> None:
    def asked(*where: Any) -> dict[str, str]:
        words = server.command(*where)
        return dict(itertools.pairwise(words))

    options = asked(Showing(web=True).request().address, 9876)
    assert (options["--bind"], options["--port"], options["--web-viewer-port"]) == (HERE, "9876", "9877")
    assert options["--cors-allow-origin"] == "http://127.0.0.1:9877"
    assert asked("192.0.2.77", 9876)["--cors-allow-origin"] == "http://192.0.2.77:9877"
    assert asked("::1", 9876)["--cors-allow-origin"] == "http://[::1]:9877"
    everywhere = asked(Showing(web=True, address=EVERYWHERE).request().address, 9876)
    assert (everywhere["--bind"], everywhere["--cors-allow-origin"]) == (EVERYWHERE, "http://*:9877")


def test_only_connections_to_the_viewer_are_cut() -> None:
    with socket.create_server((HERE, 0)) as viewer, socket.create_server((HERE, 0)) as other:
        to_viewer = socket.create_connection(viewer.getsockname())
        to_other = socket.create_connection(other.getsockname())
        far_ends = [viewer.accept()[0], other.accept()[0]]
        assert ports.cut_connections(viewer.getsockname()[1], HERE) == 1
        assert far_ends[0].recv(1) == b""
        to_other.sendall(b"x")
        assert far_ends[1].recv(1) == b"x"
        for each in (to_viewer, to_other, *far_ends):
            each.close()  # they are still their owners'


# --- a link


class Stream:
    """Counts; `blocks`: a log never ends by itself, but with the connection it sends to."""

    def __init__(self, connection: socket.socket | None = None) -> None:
        self.connection = connection
        self.logged = 0
        self.flushed_s: list[float] = []

    def log(self, *_: Any, **__: Any) -> None:
        self.logged += 1
        while self.connection is not None:
            self.connection.sendall(bytes(1 << 16))

    def flush(self, timeout_sec: float) -> None:
        self.flushed_s.append(timeout_sec)
        raise ValueError("severed")


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(link, "_PATIENCE_S", 0.2)
    monkeypatch.setattr(link, "_LOOK_S", 0.02)


def test_a_viewer_that_does_not_read_is_given_up(quick: None) -> None:
    told: list[str] = []
    with socket.create_server((HERE, 0)) as asleep:
        port = asleep.getsockname()[1]
        stream = Stream(socket.create_connection((HERE, port)))
        viewer = Link(stream, HERE, port, lambda: None, told.append)
        logging = threading.Thread(target=viewer.log, args=("a", None), daemon=True)  # would never end
        logging.start()
        logging.join(30)
        assert not logging.is_alive()
    assert told == ["the viewer does not read; going on without it"]
    assert viewer.lost == "the viewer does not read"
    viewer.log("b", None)
    viewer.flush(1.0)
    assert (stream.logged, stream.flushed_s) == (1, [])


def test_a_viewer_that_is_gone_is_told_once_and_a_recording_goes_on(quick: None) -> None:
    told: list[str] = []
    gone: list[str] = []
    recording, stream = Stream(), Stream()
    opened = Sinks(recording=recording, tell=told.append)
    opened.viewer = Link(stream, HERE, 1, lambda: gone[0] if gone else None, opened.trouble)
    opened.log("a", None)
    assert (told, len(opened.streams)) == ([], 2)
    gone.append("the viewer was closed")
    until(lambda: bool(told))
    opened.log("b", None)
    assert told == ["warning: the viewer was closed; going on without it"]
    assert opened.troubles == ["the viewer was closed; going on without it"]
    assert opened.streams == [recording]
    assert (recording.logged, stream.logged) == (2, 1)


def test_what_does_not_arrive_is_told(quick: None) -> None:
    told: list[str] = []
    viewer = Link(Stream(), HERE, 1, lambda: None, told.append)
    viewer.flush(1.5)
    assert told == ["the viewer did not take everything (severed); going on without it"]


def until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 10
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


# --- a run with a view that does not end


@pytest.fixture
def without_rerun(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Calls of what Rerun would wait with at exit."""
    calls: list[str] = []
    stand_in = SimpleNamespace(unregister_shutdown=lambda: calls.append("no waiting at exit"))
    monkeypatch.setitem(__import__("sys").modules, "rerun", stand_in)
    return calls


def test_a_run_does_not_wait_for_a_view_that_never_ends(
    monkeypatch: pytest.MonkeyPatch, without_rerun: list[str]
) -> None:
    for step in ("begin", "show_result"):
        monkeypatch.setattr(live.Picture, step, lambda self: None)
    monkeypatch.setattr(live, "_END_S", 0.2)
    opened = Sinks(recording=Stream())
    for_ever = threading.Event()
    monkeypatch.setattr(opened, "close", for_ever.wait)
    told: list[str] = []
    camera = Calibration(64, 48, 60.0, 60.0, 31.5, 23.5)
    view = LiveView(None, camera, opened, with_planes=False, tell=told.append)
    view.offer(np.zeros(1), np.zeros(1), 0.0, SimpleNamespace(world_from_camera=None))
    view.close()
    view.close()  # harmless
    for_ever.set()
    assert told == ["warning: the viewer does not end, the run goes on without it"]
    assert without_rerun[:1] == ["no waiting at exit"]


def test_nobody_waits_for_a_page_that_is_gone(capsys: pytest.CaptureFixture[str]) -> None:
    class Served:
        looks = 0

        @property
        def page(self) -> str | None:
            self.looks += 1
            return "http://here" if self.looks < 4 else None

    wait_with_page(Served())  # type: ignore[arg-type]
    said = capsys.readouterr()
    assert said.out == "the viewer stays open at http://here until Ctrl-C\n"
    assert said.err == "warning: the viewer's server has ended\n"


def test_a_finished_run_has_time_to_arrive(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    import vsgraphs.view

    limits: list[float] = []
    opened = Sinks()
    monkeypatch.setattr(opened, "close", limits.append)
    for name, stand_in in (("check_run", lambda _: None), ("show_run", lambda *_: None)):
        monkeypatch.setattr(vsgraphs.view, name, stand_in)
    monkeypatch.setattr(vsgraphs.view, "open_sinks", lambda *_: opened)
    viewing.view_run(tmp_path, Showing(view=True))
    assert limits == [60.0]


# --- with Rerun


def test_a_page_is_served_where_there_is_no_display(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("rerun", reason="the extra viz is not installed")
    from vsgraphs.view import SinkRequest, open_sinks

    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    port = next(p for p in range(21000, 30000, 2) if all(ports.is_free(q, HERE) for q in (p, p + 1)))
    told: list[str] = []
    opened = open_sinks(SinkRequest(view=True, port=port), told.append)
    expected = f"http://127.0.0.1:{port + 1}/?url=rerun%2Bhttp://127.0.0.1:{port}/proxy"
    assert told == [f"open {expected} in a browser (there is no display here)"]
    assert opened.page == expected
    assert ports.speaks_http2(port, HERE)
    with pytest.raises(InputError, match=f"port {port} .*is taken"):
        open_sinks(SinkRequest(view=True, port=port), told.append)
    opened.close()
    assert opened.troubles == []
    opened.end()
    assert opened.page is None
    until(lambda: ports.is_free(port, HERE))


def test_port_taken_ends_before_anything_opens(listener: int, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("rerun", reason="the extra viz is not installed")
    with pytest.raises(InputError, match="taken by another program"):
        RunView(Showing(web=True, port=listener))
    monkeypatch.setenv("DISPLAY", ":0")  # a window would open; what listens there is no viewer
    with pytest.raises(InputError, match="taken by another program"):
        RunView(Showing(view=True, port=listener))
