#!/usr/bin/env python3
"""Runs `vsgraphs` on sequences and measures: accuracy, completion, speed, CPU, memory, stage by stage.

    benchmarks/run_sequences.py DATA/kitchen DATA/fr1_xyz --runs 3 --json figures.json
    benchmarks/run_sequences.py DATA/* --mode threaded --mode realtime --seeds 0 1 2 3 4
    benchmarks/run_sequences.py DATA/* --vsgraphs old/bin/vsgraphs --compare new/bin/vsgraphs

Each run is a process of its own, so that its figures are those of `vsgraphs run`. Two installs are run in
turns (A B A B ...) with the same seeds, so that whatever else the machine does hits both; the table then
holds medians of the ratios of each pair, B / A. Measure on a quiet machine.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sequence_figures import COLUMNS, Figures, figures, medians, ratios, stage_table, table

MODES = {
    "threaded": ["--execution", "threaded"],
    "serial": ["--execution", "serial"],
    "realtime": ["--execution", "threaded", "--realtime"],
}

# Files that hold the truth in the formats `vsgraphs eval` reads.
TRUTH = ("groundtruth.txt", "*.gt.freiburg", "traj.txt", "frame-*.pose.txt")


@dataclass(frozen=True)
class Case:
    """One row of the table."""

    sequence: Path
    mode: str

    def name(self) -> str:
        """As shown."""
        return f"{self.sequence.resolve().name}, {self.mode}"


def run_once(program: list[str], case: Case, seed: int, extra: list[str], out: Path) -> dict[str, Any]:
    """One `vsgraphs run` and `vsgraphs eval`: {"figures", "stages", "run", "eval"}. Raises RuntimeError."""
    command = [*program, "run", str(case.sequence), "--out", str(out), "--seed", str(seed), *MODES[case.mode]]
    call([*command, *extra])
    run = json.loads((out / "run.json").read_text())
    evaluation: dict[str, Any] = {}
    if any(next(case.sequence.glob(pattern), None) for pattern in TRUTH):
        call(
            [
                *program,
                "eval",
                str(out),
                "--groundtruth",
                str(case.sequence),
                "--json",
                str(out / "eval.json"),
            ]
        )
        evaluation = json.loads((out / "eval.json").read_text())
    return {"figures": figures(run, evaluation), "stages": run["stages"], "run": run, "eval": evaluation}


def call(command: list[str]) -> str:
    """Runs a program to its end and returns what it printed. Raises RuntimeError with its last error line."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        last = done.stderr.strip().splitlines()[-1:] or ["no message"]
        raise RuntimeError(f"{' '.join(command)}\n  {last[0]}")
    return done.stdout


def arguments() -> argparse.Namespace:
    """The command line."""
    beside = Path(sys.executable).with_name("vsgraphs")
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument(
        "sequences", nargs="+", type=Path, help="folders, each with groundtruth.txt for accuracy"
    )
    parser.add_argument(
        "--mode", action="append", choices=MODES, help="repeatable; default: threaded and serial"
    )
    parser.add_argument("--runs", type=int, default=3, help="runs of each case (default 3), seeds 0, 1, ...")
    parser.add_argument("--seeds", type=int, nargs="+", help="one run for each of these seeds instead")
    parser.add_argument("--vsgraphs", default=str(beside), help=f"the program (default {beside})")
    parser.add_argument("--compare", help="another install's program, run in turns with the first")
    parser.add_argument("--json", type=Path, help="write everything measured to this file")
    parser.add_argument("--out", type=Path, help="keep the runs' results in this folder")
    parser.add_argument("--stages", action="store_true", help="print a table of stages for each case")
    parser.add_argument(
        "--option", action="append", default=[], metavar="KEY=VALUE", help="run --set KEY=VALUE"
    )
    return parser.parse_args()


def main() -> int:
    """Measures, prints tables, writes JSON."""
    options = arguments()
    programs = [[options.vsgraphs]] + ([[options.compare]] if options.compare else [])
    seeds = options.seeds or list(range(options.runs))
    extra = [word for option in options.option for word in ("--set", option)]
    cases = [
        Case(folder, mode) for folder in options.sequences for mode in options.mode or ("threaded", "serial")
    ]
    measured: dict[str, list[list[dict[str, Any]]]] = {}
    with tempfile.TemporaryDirectory(prefix="vsgraphs-benchmark-") as temporary:
        base = options.out or Path(temporary)
        for case in cases:
            runs = measured[case.name()] = [[] for _ in programs]
            for seed in seeds:
                for which, program in enumerate(programs):
                    out = base / f"{case.sequence.resolve().name}-{case.mode}-{seed}-{'AB'[which]}"
                    try:
                        runs[which].append(run_once(program, case, seed, extra, out))
                    except RuntimeError as error:
                        print(f"failed: {error}", file=sys.stderr)
                        return 1
                    print(f"{out.name}: {_short(runs[which][-1]['figures'])}", file=sys.stderr, flush=True)
    _print_tables(measured, programs, seeds, stages=options.stages)
    if options.json:
        options.json.write_text(json.dumps(_document(measured, programs, seeds), indent=1) + "\n")
    return 0


def _short(run: Figures) -> str:
    shown = ("ate_rmse_m", "completion", "fps", "track_cpu_median_ms", "cpu_s_per_1000")
    return ", ".join(f"{COLUMNS[key][0]} {run[key]:.{COLUMNS[key][1]}f}" for key in shown if key in run)


def _print_tables(
    measured: dict[str, list[list[dict[str, Any]]]],
    programs: list[list[str]],
    seeds: list[int],
    *,
    stages: bool,
) -> None:
    for which, program in enumerate(programs):
        print(f"\n{program[0]}: medians of {len(seeds)} runs, seeds {seeds}\n")
        rows = [(name, medians([one["figures"] for one in runs[which]])) for name, runs in measured.items()]
        print(table(rows))
        for name, runs in measured.items() if stages else ():
            print(f"\n{name}\n\n{stage_table(runs[which])}")
    if len(programs) == 2:
        print(f"\n{programs[1][0]} / {programs[0][0]}: medians of the ratios of {len(seeds)} pairs\n")
        print(table([(name, _ratios_of(runs)) for name, runs in measured.items()], digits=3))


def _ratios_of(runs: list[list[dict[str, Any]]]) -> Figures:
    return ratios([one["figures"] for one in runs[0]], [one["figures"] for one in runs[1]])


def _document(
    measured: dict[str, list[list[dict[str, Any]]]], programs: list[list[str]], seeds: list[int]
) -> dict[str, Any]:
    cases: dict[str, Any] = {}
    for name, runs in measured.items():
        cases[name] = {"medians": [medians([one["figures"] for one in each]) for each in runs], "runs": runs}
        if len(programs) == 2:
            cases[name]["ratios"] = _ratios_of(runs)
    machine = {"processors": os.cpu_count(), "system": platform.platform(), "machine": platform.machine()}
    return {
        "programs": [program[0] for program in programs],
        "seeds": seeds,
        "machine": machine,
        "cases": cases,
    }


if __name__ == "__main__":
    sys.exit(main())
