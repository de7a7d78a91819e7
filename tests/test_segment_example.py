"""The example of a Python function as the segmenter."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path
from typing import Any

import fake_core
import numpy as np
import pytest

from vsgraphs.segment import SurfaceRole
from vsgraphs.segment.segmentation import checked

EXAMPLE = Path(__file__).resolve().parent.parent / "examples" / "segmenter_callable.py"


@pytest.fixture
def example() -> Any:
    spec = importlib.util.spec_from_file_location("segmenter_callable", EXAMPLE)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_its_rule(example: Any) -> None:
    found = checked(example.segment(np.zeros((480, 640, 3), np.uint8)), "segment")
    assert found.roles.shape == (60, 80)
    assert (found.roles[:45] == SurfaceRole.wall).all()
    assert (found.roles[45:] == SurfaceRole.ground).all()


def test_it_hands_keyframes_over(
    example: Any,
    recorded: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    slam = fake_core.Slam()
    monkeypatch.setattr("vsgraphs.Slam", lambda config, camera: slam, raising=False)
    example.main(str(recorded))
    assert slam.finished
    assert slam.seen == 60
    found = len(slam.segmentations)
    assert found > 0
    assert capsys.readouterr().out == f"{found} keyframes segmented, {12 - found} dropped, 0 failed\n"


def test_it_runs_with_the_core(recorded: Path) -> None:
    command = [sys.executable, EXAMPLE, recorded]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    segmented, *_ = done.stdout.split()
    assert int(segmented) >= 1
    assert done.stdout.endswith(" 0 failed\n")
