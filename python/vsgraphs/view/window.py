"""The viewer's window: Rerun's program, which stays open after the run."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Callable

from vsgraphs.errors import InputError
from vsgraphs.view import ports
from vsgraphs.view.server import end_group, environment, who_can_look

_START_S = 20.0
_SETTLE_S = 0.5


def open_window(address: str, port: int, tell: Callable[[str], None]) -> str:
    """Opens one that listens there, or takes the one that does; where streams connect.

    Raises InputError: another program listens there, or there is no usable display.
    """
    data = f"rerun+http://{ports.in_url(ports.reached_at(address))}:{port}/proxy"
    if 1 <= port <= 65535 and not ports.is_free(port, address) and ports.speaks_http2(port, address):
        tell(f"showing in the viewer that is already open on port {port}")
        return data
    ports.require_free(port, address, "the viewer's data", "--view-port")
    viewer = subprocess.Popen(  # lives on after the run, and says nothing on our terminal
        [
            *(sys.executable, "-m", "rerun_cli", "--hide-welcome-screen"),
            *("--bind", address, "--port", str(port)),
        ],
        env={**environment(), "RERUN_APP_ONLY": "true"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    deadline = time.monotonic() + _START_S
    while not ports.listens(port, address) and viewer.poll() is None and time.monotonic() < deadline:
        time.sleep(0.1)
    time.sleep(_SETTLE_S)  # without a usable display it listens for a moment, then ends
    if viewer.poll() is not None or not ports.listens(port, address):
        end_group(viewer, signal.SIGTERM)  # the program behind it too
        raise InputError(
            "the viewer's window does not open (is the display usable?); --web shows it in a browser"
        )
    who_can_look(address, port, tell)
    return data
