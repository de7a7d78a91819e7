"""What several test files need."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import fake_core
import pytest
from layouts import sliding_scene, write_tum

Program = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def vsgraphs() -> Program:
    """Runs the command line in a process of its own."""

    def run(*arguments: object, **options: object) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "vsgraphs", *map(str, arguments)]
        settings: dict[str, object] = {"capture_output": True, "text": True, "timeout": 300, "check": False}
        return subprocess.run(command, **{**settings, **options})  # noqa: PLW1510  (check is in settings)

    return run


@pytest.fixture
def shared_data() -> Path:
    """The folder of recorded sequences."""
    folder = os.environ.get("VSGRAPHS_DATA")
    if not folder:
        pytest.skip("VSGRAPHS_DATA does not name the folder of recorded sequences")
    return Path(folder)


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch) -> fake_core.Slam:
    """Runs in this process are made with this stand-in for the compiled module."""
    slam = fake_core.Slam()
    core = SimpleNamespace(
        Config=fake_core.Config, Camera=lambda *_, **__: None, Slam=lambda config, camera: slam
    )
    monkeypatch.setattr("vsgraphs.compiled.core", lambda: core)
    monkeypatch.setattr("vsgraphs.run.report.core", lambda: core)
    return slam


@pytest.fixture(scope="session")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """60 frames, the camera slides 0.8 m along a wall."""
    return write_tum(tmp_path_factory.mktemp("data") / "slide", sliding_scene([2 * i for i in range(60)]))


@pytest.fixture
def sequence(recorded: Path, tmp_path: Path) -> Path:
    """A copy that a test may damage."""
    return Path(shutil.copytree(recorded, tmp_path / "slide"))


def report(out: Path) -> dict[str, Any]:
    """A run's run.json. Fails where a part of mapping failed, which a release build survives."""
    found: dict[str, Any] = json.loads((out / "run.json").read_text())
    assert not [line for line in found["warnings"] if "was switched off" in line], "a part of mapping failed"
    return found


def one_line_error(done: subprocess.CompletedProcess[str]) -> str:
    """The error line of a failed run; fails unless it is one line and exit code 2."""
    assert done.returncode == 2, (done.returncode, done.stdout, done.stderr)
    errors = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    assert len(errors) == 1, done.stderr
    assert "Traceback" not in done.stderr
    return errors[0]
