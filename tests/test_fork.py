"""A forked child has its parent's Slam without the threads: it is told so, and ends."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from layouts import Scene

import vsgraphs


@pytest.fixture
def scene() -> Scene:
    return Scene(frames=4, width=320, height=240, focal_px=300.0, shifts_px=[2 * i for i in range(4)])


@pytest.fixture(params=["threaded", "serial"])
def slam(request: pytest.FixtureRequest, scene: Scene) -> vsgraphs.Slam:
    config = vsgraphs.Config()
    config.set("system.execution", request.param)
    made = vsgraphs.Slam(config, vsgraphs.Camera(320, 240, 300.0, 300.0, 159.5, 119.5, depth_scale=5000.0))
    for i in range(3):
        made.track(np.ascontiguousarray(scene.rgb(i)), scene.depth(i), scene.stamp(i))
    return made


def in_a_child(work: Callable[[], object]) -> str:
    """What the child of a fork says; fails if it hangs."""
    read_end, write_end = os.pipe()
    child = os.fork()
    if child == 0:
        signal.alarm(20)
        try:
            said = str(work())
        except BaseException as error:
            said = f"{type(error).__name__}: {error}"
        os.write(write_end, said.encode())
        os._exit(0)
    os.close(write_end)
    with os.fdopen(read_end) as pipe:
        said = pipe.read()
    _, status = os.waitpid(child, 0)
    assert os.WIFEXITED(status), f"ended by signal {os.WTERMSIG(status)}"
    return said


def test_using_it_in_a_child_is_an_error_in_one_line(slam: vsgraphs.Slam, scene: Scene) -> None:
    told = "RunError: this Slam belongs to the process that made it; make a new one after fork()"
    for use in (
        lambda: slam.track(np.ascontiguousarray(scene.rgb(3)), scene.depth(3), scene.stamp(3)),
        slam.snapshot,
        slam.trajectory,
        slam.statistics,
        slam.atlas_state,
        slam.stop,
        slam.finish,
        slam.close,
        lambda: slam.backlog,
        slam.trace,
    ):
        assert in_a_child(use) == told
    assert issubclass(vsgraphs.errors.RunError, RuntimeError)
    assert slam.track(np.ascontiguousarray(scene.rgb(3)), scene.depth(3), scene.stamp(3)).tracked


def test_a_child_may_make_its_own(slam: vsgraphs.Slam, scene: Scene) -> None:
    def own() -> str:
        camera = vsgraphs.Camera(320, 240, 300.0, 300.0, 159.5, 119.5, depth_scale=5000.0)
        mine = vsgraphs.Slam(vsgraphs.Config(), camera)
        result = mine.track(np.ascontiguousarray(scene.rgb(0)), scene.depth(0), 1.0)
        mine.finish()
        return str(result.status)

    assert in_a_child(own) == "initialised"
    assert in_a_child(lambda: len(slam.snapshot.__name__)) == "8"  # looking at it is not using it


PROGRAM = """
import os, signal, sys
sys.path.insert(0, {tests!r})
import numpy as np, vsgraphs
from layouts import Scene
scene = Scene(frames=2, width=320, height=240, focal_px=300.0, shifts_px=[0, 2])
slam = vsgraphs.Slam(vsgraphs.Config(), vsgraphs.Camera(320, 240, 300.0, 300.0, 159.5, 119.5))
slam.track(np.ascontiguousarray(scene.rgb(0)), scene.depth(0), 1.0)
if os.fork() == 0:
    signal.alarm(20)
    {end}
_, status = os.wait()
sys.exit(os.WTERMSIG(status) if os.WIFSIGNALED(status) else os.WEXITSTATUS(status))
"""


@pytest.mark.parametrize("end", ["sys.exit(0)", "del slam; sys.exit(0)", "raise SystemExit"])
def test_a_child_ends_as_every_process_does(end: str, tmp_path: Path) -> None:
    import subprocess

    program = PROGRAM.format(tests=str(Path(__file__).parent), end=end)
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
