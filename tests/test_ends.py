"""How a run ends when it is told to, or when what it writes to goes away."""

from __future__ import annotations

import os
import pty
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import fake_core
import numpy as np
import pytest
from conftest import one_line_error, report

from vsgraphs.cli.interrupt import Interrupt
from vsgraphs.cli.run import run_sequence
from vsgraphs.datasets.sequence import FrameRef
from vsgraphs.run import RunRequest
from vsgraphs.trajectory import read_tum_trajectory

MAIN = "from vsgraphs.cli import main; print('begun', flush=True); main()"
FIRST = ["trajectory.txt", "scene_graph.json", "run.json"]


@contextmanager
def started(*arguments: object, script: str = MAIN, **options: object) -> Iterator[subprocess.Popen[str]]:
    """The program, begun; it is gone afterwards."""
    command = [sys.executable, "-c", script, *map(str, arguments)]
    settings = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen(command, **{**settings, **options}) as process:  # type: ignore[call-overload]
        try:
            if process.stdout is not None:
                assert process.stdout.readline() == "begun\n"
            yield process
        finally:
            process.kill()


def wait_until(there: Callable[[], object], limit_s: float = 60.0) -> None:
    deadline = time.monotonic() + limit_s
    while not there():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def names_in(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def opened(process: subprocess.Popen[str]) -> None:
    """Waits until the sequence is open and the results' folder made."""
    assert process.stdout is not None
    assert "frames" in process.stdout.readline()


# In the process


def raise_signal(number: int = signal.SIGINT) -> None:
    os.kill(os.getpid(), number)


def interrupted_run(recorded: Path, out: Path, slam: fake_core.Slam, monkeypatch: pytest.MonkeyPatch) -> int:
    core = SimpleNamespace(
        Config=fake_core.Config, Camera=lambda *_, **__: None, Slam=lambda config, camera: slam
    )
    monkeypatch.setattr("vsgraphs.compiled.core", lambda: core)
    monkeypatch.setattr("vsgraphs.run.report.core", lambda: core)
    return run_sequence(RunRequest(recorded, out))


class Waiting(fake_core.Slam):
    """Its fifth frame waits for mapping until it is told to stop, and is then passed over."""

    def __init__(self) -> None:
        super().__init__()
        self.told_to_stop = threading.Event()

    def track(self, rgb: np.ndarray, depth: np.ndarray, timestamp: float) -> fake_core.Result:
        if self.seen < 5:
            return super().track(rgb, depth, timestamp)
        raise_signal()
        assert self.told_to_stop.wait(30.0)
        return fake_core.Result("waiting")

    def stop(self) -> None:
        self.told_to_stop.set()


def test_ctrl_c_while_tracking_waits_for_mapping(
    recorded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    slam = Waiting()
    assert interrupted_run(recorded, tmp_path, slam, monkeypatch) == 130
    assert slam.finished
    run = report(tmp_path)
    assert (run["frames"], run["tracked"], run["interrupted"]) == (5, 5, True)


def test_ctrl_c_while_a_frame_is_waited_for(
    recorded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stalled, load = threading.Event(), FrameRef.load

    def loaded(frame: FrameRef) -> object:
        if frame.timestamp > 100.65:
            raise_signal()
            stalled.wait(60.0)
        return load(frame)

    monkeypatch.setattr(FrameRef, "load", loaded)
    began = time.monotonic()
    assert interrupted_run(recorded, tmp_path, fake_core.Slam(), monkeypatch) == 130
    stalled.set()
    assert time.monotonic() - began < 8  # less than the time limit of a frame
    assert report(tmp_path)["tracked"] <= 7


def test_a_signal_is_heard_while_the_main_thread_is_busy_and_told_to_all() -> None:
    heard, broken = threading.Event(), threading.Event()

    def failing() -> None:
        broken.set()
        raise RuntimeError

    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)]
    with Interrupt() as interrupt:
        interrupt.at_first(failing, heard.set)
        assert not interrupt.requested()
        assert interrupt.exit_code == 0
        raise_signal(signal.SIGTERM)
        assert heard.wait(10.0)
        assert broken.is_set()
        assert interrupt.requested()
        assert interrupt.exit_code == 143
        raise_signal(signal.SIGHUP)  # whoever shuts down says so in several ways
        time.sleep(0.2)
    assert before == [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)]
    assert not [thread for thread in threading.enumerate() if thread.name == "signals"]


def test_the_end_does_not_wait_for_a_disk() -> None:
    script = (
        "import signal, threading\n"
        "from vsgraphs.cli.interrupt import Interrupt\n"
        "with Interrupt(lambda: 'last words', threading.Event().wait):\n"
        "    print('begun', flush=True)\n"
        "    threading.Event().wait()\n"
    )
    with started(script=script) as process:
        process.send_signal(signal.SIGINT)
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=10)
    assert process.returncode == 130
    assert errors == "last words\n"


def test_a_signal_of_a_forked_child_is_its_own() -> None:
    with Interrupt() as interrupt:
        child = os.fork()
        if child == 0:
            signal.signal(signal.SIGTERM, lambda *_: os._exit(7))
            raise_signal(signal.SIGTERM)
            time.sleep(10)
            os._exit(8)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
        time.sleep(0.1)
        assert not interrupt.requested()


# A second one


BLOCKED = """
import sys, threading
import vsgraphs.run.writing as results
from vsgraphs.cli import main
results.format_ply = lambda *_: threading.Event().wait()
print("begun", flush=True)
main()
"""


def test_a_second_ctrl_c_skips_what_is_left(recorded: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    arguments = ("run", recorded, "--out", out, "--save-atlas", out / "map.vsg", "--realtime")
    with started(*arguments, "--autosave", 0.3, script=BLOCKED) as process:
        wait_until((out / "map.vsg").exists)  # there are keyframes
        process.send_signal(signal.SIGINT)
        wait_until((out / "keyframes.txt").exists)
        time.sleep(0.3)
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=30)
        took = time.monotonic() - began
    assert process.returncode == 130, errors
    assert took < 5  # 0.5 on a machine of one's own
    last = errors.splitlines()[-1]
    assert f"written in {out}: trajectory.txt, scene_graph.json, {out / 'map.vsg'}, run.json" in last
    assert "not written: map.ply, floorplan.svg, planes.ply, scene_graph.dsg.json, timeline.json" in last
    assert sorted(path.name for path in out.iterdir()) == sorted([*FIRST, "map.vsg", "keyframes.txt"])
    assert report(out)["interrupted"] is True
    assert len(read_tum_trajectory(out / "trajectory.txt")) == report(out)["tracked"]


def test_a_terminal_that_hangs_up_twice_does_not_skip_anything(recorded: Path, tmp_path: Path) -> None:
    with started("run", recorded, "--out", tmp_path, "--realtime") as process:
        opened(process)
        time.sleep(1.5)
        process.send_signal(signal.SIGHUP)
        time.sleep(0.15)
        process.send_signal(signal.SIGHUP)
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 129, errors
    assert (tmp_path / "timeline.json").is_file()


# Terminals and pipes that go away


def test_a_terminal_that_is_gone_costs_no_results(recorded: Path, tmp_path: Path) -> None:
    master, slave = pty.openpty()

    def on_the_terminal() -> None:
        os.setsid()
        os.close(os.open(os.ttyname(0), os.O_RDWR))  # makes it the controlling one

    arguments = ("run", recorded, "--out", tmp_path, "--realtime")
    streams = {"stdin": slave, "stdout": slave, "stderr": slave, "preexec_fn": on_the_terminal}
    with started(*arguments, **streams) as process:
        os.close(slave)
        shown = b""
        while b"/60 frames" not in shown:  # the first ones are tracked
            shown += os.read(master, 1000)
        os.close(master)
        process.wait(timeout=60)
    assert process.returncode == 129
    run = report(tmp_path)
    assert run["interrupted"] is True
    assert run["tracked"] > 0
    assert (tmp_path / "timeline.json").is_file()


def test_output_nobody_reads_costs_no_results(recorded: Path, tmp_path: Path) -> None:
    with started("run", recorded, "--out", tmp_path, "--max-frames", 12) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        process.stderr.close()
        assert process.wait(timeout=60) == 0
    assert report(tmp_path)["tracked"] == 12


def test_nohup_is_respected(recorded: Path, tmp_path: Path) -> None:
    def nohup() -> None:
        signal.signal(signal.SIGHUP, signal.SIG_IGN)

    arguments = ("run", recorded, "--out", tmp_path, "--max-frames", 12)
    with started(*arguments, preexec_fn=nohup) as process:
        process.send_signal(signal.SIGHUP)
        opened(process)
        process.send_signal(signal.SIGHUP)
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 0, errors
    assert report(tmp_path)["tracked"] == 12


# Folders that go away


@pytest.mark.parametrize("how", ["removed", "renamed"])
def test_results_of_a_folder_that_is_gone_are_beside_it(recorded: Path, tmp_path: Path, how: str) -> None:
    out = tmp_path / "results"
    arguments = ("run", recorded, "--out", out, "--realtime", "--max-frames", 25)
    with started(*arguments, "--save-atlas", out / "map.vsg") as process:
        opened(process)
        if how == "removed":
            shutil.rmtree(out)
        else:
            out.rename(tmp_path / "elsewhere")
        told, errors = process.communicate(timeout=60)
    assert process.returncode == 0, errors
    beside = tmp_path / "results-2"
    assert f"the results are in {beside}" in errors
    assert f"results in {beside}" in told
    run = report(beside)
    assert run["frames"] == 25
    assert any(f"the results are in {beside}" in line for line in run["warnings"])
    assert {*FIRST, "map.vsg", "map.ply", "timeline.json"} <= {path.name for path in beside.iterdir()}
    assert not out.exists()


def test_a_folder_that_is_another_run_s_by_now_is_left_alone(recorded: Path, tmp_path: Path) -> None:
    out = tmp_path / "results"
    with started("run", recorded, "--out", out, "--realtime", "--max-frames", 25) as process:
        opened(process)
        shutil.rmtree(out)
        out.mkdir()
        (out / ".lock").write_text("of another run")
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 0, errors
    assert f"what this run left is in {tmp_path / 'results-2'}" in errors
    assert names_in(out) == [".lock"]
    assert report(tmp_path / "results-2")["frames"] == 25


def test_nowhere_to_write_to_is_one_line(recorded: Path, tmp_path: Path) -> None:
    out = tmp_path / "deep" / "results"
    with started("run", recorded, "--out", out, "--realtime", "--max-frames", 15) as process:
        opened(process)
        shutil.rmtree(tmp_path / "deep")
        (tmp_path / "deep").write_text("no folder can be made here")
        told, errors = process.communicate(timeout=60)
    done = subprocess.CompletedProcess([], process.returncode, told, errors)
    assert "trajectory.txt: Not a directory, nor" in one_line_error(done)


# Ctrl-C at any time


@pytest.mark.parametrize(
    ("command", "delay_s"), [("run", s) for s in (0.0, 0.03, 0.1, 0.3, 0.8, 1.6)] + [("config", 0.1)]
)
def test_ctrl_c_never_shows_a_trace(recorded: Path, tmp_path: Path, command: str, delay_s: float) -> None:
    arguments = ("run", recorded, "--out", tmp_path, "--max-frames", 12) if command == "run" else ("config",)
    with started(*arguments) as process:
        time.sleep(delay_s)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
    assert process.returncode in (0, 130, -signal.SIGINT), errors
    assert "Traceback" not in errors
    assert "KeyboardInterrupt" not in errors
    assert "Exception ignored" not in errors
    if command == "run" and process.returncode == 0:
        assert report(tmp_path)["tracked"] == 12
