"""`vsgraphs.run`: what the command does, from Python."""

from __future__ import annotations

import inspect
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import fake_core
import numpy as np
import pytest
from conftest import Program, report

import vsgraphs
from vsgraphs.run import Message, Progress, Result
from vsgraphs.scene_graph import load_scene_graph
from vsgraphs.trajectory import read_tum_trajectory

FILES = ("trajectory.txt", "keyframes.txt", "map.ply", "scene_graph.json", "scene_graph.dsg.json")
FILES += ("floorplan.svg", "planes.ply")


def test_the_same_bytes_as_the_command(
    recorded: Path, tmp_path: Path, vsgraphs: Program, capfd: pytest.CaptureFixture[str]
) -> None:
    import vsgraphs as package

    result = package.run(recorded, tmp_path / "a", execution="serial", seed=3, max_frames=30)
    assert capfd.readouterr() == ("", "")
    arguments = ("--execution", "serial", "--seed", 3, "--max-frames", 30)
    assert vsgraphs("run", recorded, "--out", tmp_path / "b", *arguments).returncode == 0
    for name in FILES:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    assert set(result.files) == {*FILES, "run.json", "timeline.json"}
    assert result.info == report(tmp_path / "a")
    assert list(result.info) == list(report(tmp_path / "b"))


def test_the_result_is_what_the_files_hold(recorded: Path, tmp_path: Path) -> None:
    result = vsgraphs.run(str(recorded), out=str(tmp_path), options={"system.seed": 5}, max_frames=20)
    assert isinstance(result, vsgraphs.Result)
    assert result.info["seed"] == 5
    assert result.folder == tmp_path
    assert sum(result.statuses.values()) == 20
    written = read_tum_trajectory(tmp_path / "trajectory.txt")
    np.testing.assert_allclose(result.trajectory.poses, written.poses, atol=1e-6)
    assert len(result.keyframes) == result.info["keyframes"]
    assert result.scene_graph is not None
    assert set(result.scene_graph.planes) == set(load_scene_graph(tmp_path / "scene_graph.json").planes)
    assert result.warnings == result.info["warnings"]
    assert not result.interrupted
    assert "20 of 20 frames" in repr(result)


def test_without_out_there_is_a_new_folder(
    recorded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fake: fake_core.Slam
) -> None:
    monkeypatch.chdir(tmp_path)
    assert [vsgraphs.run(recorded).folder.name for _ in "ab"] == ["slide_vsgraphs", "slide_vsgraphs-2"]


def test_how_it_goes_is_told(recorded: Path, tmp_path: Path, fake: fake_core.Slam) -> None:
    shown: list[Progress] = []
    said: list[Message] = []
    fake.script = ["ok"] * 10 + ["lost"] * 2
    vsgraphs.run(recorded, tmp_path, on_progress=shown.append, on_message=said.append)
    frames = [progress for progress in shown if not progress.doing]
    assert [progress.seen for progress in frames] == list(range(1, 61))
    assert (frames[11].status, frames[11].tracked, frames[11].total) == ("lost", 10, 60)
    assert "writing trajectory.txt" in [progress.doing for progress in shown]
    assert said[0].kind == "note"
    assert "60 frames" in said[0].text
    assert next(m for m in said if m.kind == "event").text.startswith("lost at frame 10")


def test_mistakes_are_exceptions_of_one_line(recorded: Path, tmp_path: Path) -> None:
    with pytest.raises(vsgraphs.InputError, match=r"^nowhere does not exist$"):
        vsgraphs.run("nowhere", out=tmp_path)
    with pytest.raises(vsgraphs.InputError, match=r"^options: unknown option 'tracker\.nonsense'"):
        vsgraphs.run(recorded, out=tmp_path, options={"tracker.nonsense": 1})
    with pytest.raises(vsgraphs.InputError, match="map-colours"):
        vsgraphs.run(recorded, out=tmp_path, map_colours="blue")
    with pytest.raises(TypeError, match="nonsense"):
        vsgraphs.run(recorded, out=tmp_path, nonsense=3)  # type: ignore[call-arg]


def test_an_exception_of_a_callback_keeps_what_was_tracked(
    recorded: Path, tmp_path: Path, fake: fake_core.Slam
) -> None:
    def show(progress: Progress) -> None:
        if progress.seen == 10:
            raise ValueError("mine")

    with pytest.raises(ValueError, match="mine"):
        vsgraphs.run(recorded, tmp_path, on_progress=show)
    assert report(tmp_path)["tracked"] == 10


def test_stop_ends_it_with_results(recorded: Path, tmp_path: Path, fake: fake_core.Slam) -> None:
    result = vsgraphs.run(recorded, tmp_path, stop=lambda: fake.seen >= 7)
    assert (result.info["tracked"], result.interrupted, fake.stopped) == (7, True, True)


@pytest.fixture
def listening() -> Iterator[None]:
    """Ctrl-C is heard, as it is not in a program that a shell started in the background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("listening")
def test_ctrl_c_keeps_results_and_the_handler(recorded: Path, tmp_path: Path, fake: fake_core.Slam) -> None:
    before = signal.getsignal(signal.SIGINT)

    def interrupt(progress: Progress) -> None:
        if progress.seen == 5 and not progress.doing:
            os.kill(os.getpid(), signal.SIGINT)

    result = vsgraphs.run(recorded, tmp_path, on_progress=interrupt)
    assert result.interrupted
    assert result.info["tracked"] in (5, 6)
    assert report(tmp_path)["interrupted"] is True
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.usefixtures("listening")
def test_a_second_ctrl_c_is_a_keyboard_interrupt(
    recorded: Path, tmp_path: Path, fake: fake_core.Slam
) -> None:
    def interrupt(progress: Progress) -> None:
        if progress.seen == 5 or progress.doing:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        vsgraphs.run(recorded, tmp_path, on_progress=interrupt)
    vsgraphs.run(recorded, tmp_path, max_frames=5)  # nothing is held


def test_on_another_thread(recorded: Path, tmp_path: Path, fake: fake_core.Slam) -> None:
    results: list[Result] = []
    thread = threading.Thread(target=lambda: results.append(vsgraphs.run(recorded, tmp_path)))
    thread.start()
    thread.join(60)
    assert results[0].info["tracked"] == 60


def test_it_is_one_function_however_it_is_reached() -> None:
    assert "max_frames" in inspect.signature(vsgraphs.run).parameters
    for first in ("import vsgraphs", "import vsgraphs.run.summary", "from vsgraphs.run import run"):
        code = f"{first}\nimport vsgraphs\ntry:\n vsgraphs.run('nowhere')\nexcept ValueError as e: print(e)"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        assert done.stdout == "nowhere does not exist\n"
