"""Runs whose page is served by a process of its own, and what happens to that process.

Each with a stand-in for Rerun (fake_rerun), and with Rerun itself where that is installed.
"""

from __future__ import annotations

import importlib.util
import os
import resource
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from conftest import Program, one_line_error, report
from test_run import OUTPUTS

from vsgraphs.view import ports

FRAMES = 30
ASLEEP = "the viewer does not read; going on without it"
GONE = "the viewer's server has ended; going on without it"
FAKE = Path(__file__).parent / "fake_rerun"


@pytest.fixture(params=["fake", "rerun"])
def environment(request: pytest.FixtureRequest) -> dict[str, str]:
    """Without a display; with a stand-in for Rerun, or the real one."""
    found = {name: value for name, value in os.environ.items() if "DISPLAY" not in name}
    if request.param == "rerun":
        if importlib.util.find_spec("rerun_cli") is None:
            pytest.skip("the extra viz is not installed")
        return found
    return with_fake(found)


def with_fake(environment: dict[str, str]) -> dict[str, str]:
    before = environment.get("PYTHONPATH")
    return {**environment, "PYTHONPATH": os.pathsep.join([str(FAKE), *([before] if before else [])])}


@pytest.fixture
def port() -> int:
    return next(p for p in range(21000, 30000, 2) if all(ports.is_free(q, "127.0.0.1") for q in (p, p + 1)))


class Run:
    """A run with a page, from when that is served."""

    def __init__(self, arguments: list[object], environment: dict[str, str], port: int, log: Path) -> None:
        self.port = port
        self.fake = str(FAKE) in environment.get("PYTHONPATH", "")
        self._log = log
        with log.open("w") as lines:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "vsgraphs", *map(str, arguments), "--web", "--view-port", str(port)],
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=lines,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                preexec_fn=few_descriptors,  # noqa: PLW1509  (no threads here)
            )
        wait_for(lambda: "open http" in self.text() or self.process.poll() is not None)
        assert self.process.poll() is None, self.text()
        self.server = descendants(self.process.pid)

    def text(self) -> str:
        return self._log.read_text()

    def end(self) -> int:
        return self.process.wait(timeout=60)

    def hit(self, number: int) -> None:
        for pid in self.server:
            if b"--serve-web" in command_line(pid) and b"guard.py" not in command_line(pid):
                os.kill(pid, number)


def few_descriptors() -> None:
    resource.setrlimit(resource.RLIMIT_NOFILE, (128, 128))


def descendants(pid: int) -> list[int]:
    """What a process has started, and what that has."""
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [each for child in map(int, children) for each in (child, *descendants(child))]


def command_line(pid: int) -> bytes:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes()  # empty: ended, and nobody has asked how
    except OSError:
        return b""


def wait_for(condition: Callable[[], bool], limit_s: float = 30.0) -> None:
    deadline = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


@pytest.fixture
def start(
    recorded: Path, tmp_path: Path, environment: dict[str, str], port: int
) -> Iterator[Callable[..., Run]]:
    started: list[Run] = []

    def run(*arguments: object) -> Run:
        command = ["run", recorded, "--out", tmp_path / "out", "--max-frames", FRAMES, *arguments]
        started.append(Run(command, environment, port, tmp_path / "log"))
        return started[-1]

    yield run
    for each in started:
        for pid in (each.process.pid, *each.server):
            if command_line(pid):
                os.kill(pid, signal.SIGKILL)
        each.process.wait()


def check_whole(run: Run, out: Path, warnings: list[str]) -> None:
    """All results are there, one line for each trouble, and nothing goes on running."""
    assert run.end() == 0, run.text()
    assert "Traceback" not in run.text()
    assert sorted(path.name for path in out.iterdir()) == sorted(OUTPUTS)
    assert [line for line in run.text().splitlines() if "viewer" in line and "page" not in line] == [
        f"warning: {each}" for each in warnings
    ]
    assert [each for each in report(out)["warnings"] if "viewer" in each] == warnings
    assert report(out)["frames"] == FRAMES
    wait_for(lambda: not any(map(command_line, run.server)))


def test_the_page_is_for_this_machine_and_ends_with_the_run(
    start: Callable[..., Run], tmp_path: Path
) -> None:
    run = start("--realtime")
    with urllib.request.urlopen(f"http://127.0.0.1:{run.port + 1}/") as page:
        assert page.status == 200
    for port in (run.port, run.port + 1):
        assert ports.listens(port, "127.0.0.1")
        assert ports.is_free(port, "127.0.0.2")  # it would not be if the server took all addresses
    for pid in run.server:
        assert os.getsid(pid) != os.getsid(run.process.pid)  # Ctrl-C is for the run
    check_whole(run, tmp_path / "out", [])
    assert report(tmp_path / "out")["view"]["shown"] > 0
    assert "the viewer's page ends with this program" in run.text()


def test_a_server_that_is_killed_costs_a_line(start: Callable[..., Run], tmp_path: Path) -> None:
    run = start("--realtime")
    run.hit(signal.SIGKILL)
    check_whole(run, tmp_path / "out", [GONE])


def test_a_server_that_stops_reading_costs_a_line(start: Callable[..., Run], tmp_path: Path) -> None:
    run = start("--record", tmp_path / "run.rrd")
    run.hit(signal.SIGSTOP)
    assert run.end() == 0, run.text()
    told = [ASLEEP] if ASLEEP in run.text() else []  # so little, Rerun and the kernel can keep for it
    check_whole(run, tmp_path / "out", told)
    assert told or not run.fake
    recording = (tmp_path / "run.rrd").read_bytes()
    assert b"/world/camera/image" in recording  # what was logged after the camera's path was begun
    assert b"/world/path" in recording


def test_a_flood_of_connections_is_the_servers_alone(start: Callable[..., Run], tmp_path: Path) -> None:
    run = start("--realtime")
    flood: list[socket.socket] = []
    for _ in range(200):
        try:
            flood.append(socket.create_connection(("127.0.0.1", run.port), timeout=0.2))
        except OSError:
            break
    assert len(flood) > 20
    assert run.end() == 0, run.text()
    told = [GONE] if GONE in run.text() else []  # whether it ends is the server's own affair
    check_whole(run, tmp_path / "out", told)
    for connection in flood:
        connection.close()


def test_a_run_that_is_killed_takes_the_server_along(start: Callable[..., Run]) -> None:
    run = start("--realtime")
    assert all(map(command_line, run.server))
    run.process.kill()
    run.process.wait()
    wait_for(lambda: not any(map(command_line, run.server)))


def test_a_server_that_does_not_start_ends_before_the_run(
    recorded: Path, tmp_path: Path, vsgraphs: Program, port: int
) -> None:
    environment = {**with_fake(dict(os.environ)), "FAKE_SERVER": "never"}
    arguments = ("--out", tmp_path / "out", "--web", "--view-port", port)
    error = one_line_error(vsgraphs("run", recorded, *arguments, env=environment))
    assert "the viewer's server does not start; why, tells: python -m rerun_cli --serve-web --bind" in error


def test_where_it_listens_is_checked_first(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "trajectory.txt").write_text("0 0 0 0 0 0 0 1\n")
    for command in (("run", recorded, "--out", tmp_path / "out"), ("view", tmp_path / "results")):
        done = vsgraphs(*command, "--web", "--view-address", "kitchen")
        assert "--view-address kitchen: must be an IP address of this machine" in one_line_error(done)
    assert not (tmp_path / "out" / "run.json").exists()
