from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from layouts import Scene, write_tum

SCRIPT = Path(__file__).resolve().parent.parent / "benchmarks" / "run_sequences.py"
sys.path.insert(0, str(SCRIPT.parent))
import sequence_figures  # noqa: E402


def test_medians_and_ratios() -> None:
    first = [{"fps": 10.0, "ate_rmse_m": 0.1}, {"fps": 30.0}, {"fps": 20.0, "ate_rmse_m": 0.3}]
    second = [
        {"fps": 11.0, "ate_rmse_m": 0.1},
        {"fps": 60.0, "ate_rmse_m": 9.0},
        {"fps": 18.0, "ate_rmse_m": 0.15},
    ]
    assert sequence_figures.medians(first) == pytest.approx({"fps": 20.0, "ate_rmse_m": 0.2})
    assert sequence_figures.ratios(first, second) == pytest.approx(
        {"fps": 1.1, "ate_rmse_m": 0.75}
    )  # pair by pair


def test_table() -> None:
    text = sequence_figures.table(
        [("desk, threaded", {"fps": 81.26, "ate_rmse_m": 0.01}), ("hall, serial", {"fps": 7.0})]
    )
    assert text.splitlines()[0] == "| | ATE m | frames/s |"
    assert text.splitlines()[2:] == ["| desk, threaded | 0.0100 | 81.3 |", "| hall, serial | - | 7.0 |"]


def test_two_installs_pair_by_pair(tmp_path: Path) -> None:
    shifts = [2 * i for i in range(15)]
    folder = write_tum(
        tmp_path / "slide", Scene(frames=15, width=320, height=240, focal_px=300.0, shifts_px=shifts)
    )
    program = tmp_path / "vsgraphs"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m vsgraphs "$@"\n')
    program.chmod(0o755)
    figures = tmp_path / "figures.json"
    command = [sys.executable, SCRIPT, folder, "--vsgraphs", program, "--compare", program, "--runs", "2"]
    done = subprocess.run(
        [*command, "--mode", "serial", "--stages", "--json", figures],
        capture_output=True,
        text=True,
        check=False,
        env=dict(os.environ),
    )
    assert done.returncode == 0, done.stderr
    order = [line.partition(":")[0] for line in done.stderr.splitlines()]
    assert order == [f"slide-serial-{seed}-{which}" for seed in (0, 1) for which in "AB"]
    assert "| track |" in done.stdout
    case = json.loads(figures.read_text())["cases"]["slide, serial"]
    assert case["ratios"]["ate_rmse_m"] == pytest.approx(1.0)  # the same program and seed, serial
    assert case["medians"][0]["completion"] == 1.0
    assert len(case["runs"][1]) == 2


def test_a_failing_run_is_told(tmp_path: Path) -> None:
    command = [sys.executable, SCRIPT, tmp_path, "--vsgraphs", "/bin/false", "--runs", "1"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr.startswith("failed: /bin/false run")
