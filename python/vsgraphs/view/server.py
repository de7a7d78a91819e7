"""The server of the page for browsers: Rerun's, in a process of its own.

Whoever floods or breaks it ends that process and not the run. It ends with the run.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

from vsgraphs.errors import InputError
from vsgraphs.view import ports

_MEMORY = "1GiB"  # of what a browser that comes late still gets; the oldest goes first
_START_S = 60.0  # one that has ended is noticed at once
_END_S = 2.0


def command(address: str, port: int) -> list[str]:
    """What is started: data is taken and given at `port`, the page one above."""
    hosts = "*" if ports.reached_at(address) != address else ports.in_url(address)
    return [
        *(sys.executable, "-m", "rerun_cli", "--serve-web"),
        *("--bind", address, "--port", str(port), "--web-viewer-port", str(port + 1)),
        *("--server-memory-limit", _MEMORY),
        *("--cors-allow-origin", f"http://{hosts}:{port + 1}"),  # or the page may not fetch the data
    ]


class Server:
    """Serves at `address`, from when it is made until `end`, or until this process is gone.

    data: where streams connect. page: what a browser on this machine opens.
    """

    def __init__(self, address: str, port: int) -> None:
        """Raises InputError: a port is taken, or the server does not start."""
        ports.require_free(port, address, "the viewer's data", "--view-port")
        ports.require_free(port + 1, address, "the viewer's page", "--view-port")
        host = ports.in_url(ports.reached_at(address))
        self.data = f"rerun+http://{host}:{port}/proxy"
        self.page = f"http://{host}:{port + 1}/?url={self.data.replace('+', '%2B')}"
        program = command(address, port)
        self._ending = threading.Lock()
        self._guard = subprocess.Popen(
            [sys.executable, str(Path(__file__).with_name("guard.py")), *program],
            env=environment(),
            stdin=subprocess.PIPE,  # closes with this process; nothing is written
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,  # Ctrl-C in the terminal is for the run
        )
        answering = [port, port + 1]
        deadline = time.monotonic() + _START_S
        while answering and self.alive() and time.monotonic() < deadline:
            time.sleep(0.05)
            answering = [each for each in answering if not ports.listens(each, address)]
        if answering or not self.alive():
            self.end()
            raise InputError(
                f"the viewer's server does not start; why, tells: {' '.join(('python', *program[1:]))}"
            )

    def alive(self) -> bool:
        """Whether the process is there."""
        if self._guard.returncode is not None:
            return False
        with contextlib.suppress(ChildProcessError):  # another thread's `end` came first
            if os.waitid(os.P_PID, self._guard.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
                return True
        self.end()
        return False

    def end(self) -> None:
        """Ends it at once; all it holds is a copy."""
        with self._ending:
            if self._guard.returncode is None:
                end_group(self._guard, signal.SIGKILL)  # one that is stopped too
            if self._guard.stdin is not None:
                self._guard.stdin.close()


def environment() -> dict[str, str]:
    """For Rerun's programs: quiet, and not taken from the working directory."""
    return {**os.environ, "RUST_LOG": "off", "TELEMETRY_ENABLED": "false", "PYTHONSAFEPATH": "1"}


def end_group(leader: subprocess.Popen[bytes], number: signal.Signals) -> None:
    """Signals a program and what it has started, and waits a little for the program."""
    with contextlib.suppress(OSError):
        os.killpg(leader.pid, number)
    with contextlib.suppress(subprocess.TimeoutExpired):
        leader.wait(timeout=_END_S)


def who_can_look(address: str, port: int, tell: Callable[[str], None]) -> None:
    """Says it plainly, where that is more than this machine."""
    if ports.is_private(address):
        return
    tell(
        f"warning: anybody who reaches {ports.in_url(address)}:{port} can see the camera's images and "
        "write into the view; there is no password"
    )
