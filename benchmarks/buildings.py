#!/usr/bin/env python3
"""Runs `vsgraphs` through whole buildings: accuracy, maps, loops, rooms and doors, over draws of the noise.

    benchmarks/buildings.py OUT --plans office_12.json office_24.json --draws 0 1 --every 3
    benchmarks/buildings.py OUT --buildings line-24-4 ring-16-4 --set system.loop_closing=false
    benchmarks/buildings.py OUT --buildings line-12-1 --variant plain --variant open system.loop_closing=false

Plans are simulated into OUT/sequences once. Each run is a line of OUT/results.jsonl, its results lie in
OUT/runs. What the file holds already of this build, plan, draw, seed and options is not run again, so that
a call that was stopped goes on where it was. A building is KIND-ROOMS-FURNISHINGS[-SEED], as `vsgraphs
simulate --building` makes it. ATE: RMSE after rigid alignment, no scale.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ablation_runs import Variant, build_of
from building_places import Place, Places
from building_runs import Results, measured, run_folder
from building_tables import draws_table, runs_table

MODE = "full"


@dataclass(frozen=True)
class Run:
    """What is to be run."""

    place: Place
    variant: Variant
    key: dict[str, Any]

    def name(self) -> str:
        """As shown."""
        key = self.key
        return f"{key['place']} {key['variant']} draw {key['draw']} seed {key['seed']}"


def arguments() -> argparse.Namespace:
    """The command line."""
    beside = Path(sys.executable).with_name("vsgraphs")
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("folder", type=Path, metavar="OUT", help="sequences, runs and results.jsonl go here")
    add("--plans", type=Path, nargs="+", default=[], metavar="FILE", help="plan files")
    add("--buildings", nargs="+", default=[], metavar="NAME", help="generated buildings, as line-24-4")
    add("--draws", type=int, nargs="+", default=[0], help="draws of the sensor's noise (default 0)")
    add("--seeds", type=int, nargs="+", default=[0], help="`run --seed` (default 0)")
    add("--set", action="extend", nargs="+", default=[], metavar="KEY=VALUE", help="options of every run")
    add(
        "--variant",
        action="append",
        nargs="+",
        default=[],
        metavar=("NAME", "KEY=VALUE"),
        help="a row of its own with these options besides; repeatable; a name alone: as --set says",
    )
    add("--every", type=int, default=1, help="keep only each n-th frame (default 1)")
    add("--frames", type=int, help="simulate and run at most so many frames")
    add("--jobs", type=int, choices=(1, 2), default=1, help="runs at a time (default 1)")
    add("--execution", choices=("serial", "threaded"), default="serial", help="default serial: repeatable")
    add("--vsgraphs", default=str(beside), help=f"the program (default {beside})")
    return parser.parse_args()


def variants_of(options: argparse.Namespace) -> list[Variant]:
    """What is run of each sequence. Raises ValueError."""
    given = options.variant or [["default"]]
    found = [Variant(name, MODE, [*options.set, *settings]) for name, *settings in given]
    wrong = [setting for variant in found for setting in variant.settings if "=" not in setting]
    if wrong:
        raise ValueError(f"'{wrong[0]}' is not KEY=VALUE")
    names = [variant.name for variant in found]
    if len(set(names)) < len(names):
        raise ValueError(f"two variants have the same name: {', '.join(names)}")
    return found


def runs_of(options: argparse.Namespace, places: list[Place], build: str) -> list[Run]:
    """In order: the variants of a sequence follow one another. Raises ValueError."""
    if not places:
        raise ValueError("nothing to run: give --plans or --buildings")
    return [
        Run(place, variant, _key(options, place, variant, build) | {"draw": draw, "seed": seed})
        for place in places
        for draw in options.draws
        for seed in options.seeds
        for variant in variants_of(options)
    ]


def _key(options: argparse.Namespace, place: Place, variant: Variant, build: str) -> dict[str, Any]:
    return {
        "build": build,
        "place": place.name,
        "plan": place.digest,
        "every": options.every,
        "frames": options.frames,
        "variant": variant.name,
        "settings": variant.settings,
        "execution": options.execution,
    }


def make(run: Run, places: Places, results: Results) -> str | None:
    """Simulates and runs unless that was done before; returns what went wrong."""
    if results.of(run.key) is not None:
        return None
    try:
        sequence = places.sequence(run.place, run.key["draw"])
        out = places.folder / "runs" / run_folder(run.key)
        figures = measured(places.program, sequence, run.key, run.variant, out)
    except RuntimeError as error:
        print(f"{run.name()}: failed: {error}", file=sys.stderr, flush=True)
        return str(error)
    results.add(run.key, figures)
    ate = figures["ate_rmse_m"]
    shown = "no ATE" if ate is None else f"ATE {ate:.4f} m"
    print(f"{run.name()}: {shown}, CPU {figures['cpu_s']:.0f} s", file=sys.stderr, flush=True)
    return None


def main() -> int:
    """Runs, keeps, prints tables."""
    options = arguments()
    places = Places([options.vsgraphs], options.folder, options.every, options.frames)
    try:
        build = build_of(options.vsgraphs)
        results = Results(options.folder / "results.jsonl")
        wanted = [Place.of(plan) for plan in options.plans]
        wanted += [places.building(name) for name in options.buildings]
        runs = runs_of(options, wanted, build)
    except (ValueError, RuntimeError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    pool = ThreadPoolExecutor(options.jobs)
    try:
        failures = [failure for failure in pool.map(lambda run: make(run, places, results), runs) if failure]
    except KeyboardInterrupt:
        pool.shutdown(cancel_futures=True)
        print("stopped: the same call goes on", file=sys.stderr)
        return 130
    rows = [row for run in runs if (row := results.of(run.key)) is not None]
    if rows:
        print(f"build {build}, {options.execution}, every {options.every}\n\n{runs_table(rows)}")
        print(f"\nMedian / worst over draws and seeds\n\n{draws_table(rows)}")
    if failures:
        print(f"{len(failures)} of {len(runs)} runs failed and are in no table", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
