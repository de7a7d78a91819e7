"""What several test files need."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

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
