#!/usr/bin/env python3
"""What each layer of `vsgraphs` is worth: the same sequences, noise draws and seeds in every mode.

    benchmarks/ablation.py --list building_components --cache out/sim --draws 1 2 3 --json ablation.json
    benchmarks/ablation.py one_room rendered_room --every 3 --variant loose:scene.role.min_observations=1
    benchmarks/ablation.py three_rooms --mode slam --mode bc --realtime

Names are recordings in the folder that VSGRAPHS_DATA names, paths of recordings, or plans of `vsgraphs
simulate`, which are rendered into --cache once. The gain of a variant is 1 - ATE / ATE of the baseline, of
runs with the same draw and seed; each sequence's mean gain counts once in the mean. Runs go one after the
other. Those that --json already holds from the same build are not made again.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from pathlib import Path
from typing import Any

from ablation_runs import MODES, Variant, build_of, known_modes, measure, parse_variant
from ablation_sequences import LISTS, Sequences
from ablation_tables import accuracy_table, figures_table, gains_table, summary
from run_sequences import Case


def arguments() -> argparse.Namespace:
    """The command line."""
    beside = Path(sys.executable).with_name("vsgraphs")
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    add = parser.add_argument
    add("sequences", nargs="*", help="recordings in VSGRAPHS_DATA, paths of recordings, plans to simulate")
    add("--list", choices=LISTS, help="the sequences of a fixed list")
    add("--mode", action="append", choices=MODES, help="repeatable; default: all that the program knows")
    add(
        "--variant",
        action="append",
        default=[],
        metavar="NAME:KEY=VALUE,...",
        help="another column; repeatable",
    )
    add("--baseline", default="slam", help="the variant that gains are measured against (default slam)")
    add("--draws", type=int, nargs="+", default=[1, 2, 3, 4, 5], help="noise of simulations (default 1 to 5)")
    add("--runs", type=int, default=1, help="runs of each, seeds 0, 1, ... (default 1)")
    add("--every", type=int, default=1, help="keep only each n-th frame of simulations (default 1)")
    add("--cache", type=Path, default=Path("out/simulated"), help="simulations (default out/simulated)")
    add("--execution", choices=("serial", "threaded"), default="serial", help="default serial: repeatable")
    add("--realtime", action="store_true", help="threaded at the camera's pace; late frames are dropped")
    add("--vsgraphs", default=str(beside), help=f"the program (default {beside})")
    add("--json", type=Path, help="everything measured; what it already holds is not measured again")
    return parser.parse_args()


def variants_of(options: argparse.Namespace) -> list[Variant]:
    """The columns. Raises ValueError, RuntimeError."""
    known = known_modes([options.vsgraphs])
    modes = options.mode or known
    missing = [mode for mode in modes if mode not in known]
    if missing:
        raise ValueError(f"{options.vsgraphs} does not know mode {missing[0]}")
    found = [Variant(mode, mode) for mode in modes]
    found += [parse_variant(text, known[-1]) for text in options.variant]
    taken = [variant.name for variant in found]
    if len(set(taken)) < len(taken):
        raise ValueError(f"two variants have the same name: {', '.join(taken)}")
    if options.baseline not in taken:
        raise ValueError(f"the baseline {options.baseline} is none of {', '.join(taken)}")
    return found


def keys_of(
    options: argparse.Namespace, variants: list[Variant], sequences: Sequences, build: str
) -> list[dict[str, Any]]:
    """What tells each run from all others, in the order of the runs: those of a pair follow one another."""
    names = list(dict.fromkeys([*(LISTS[options.list] if options.list else ()), *options.sequences]))
    if not names:
        raise ValueError("no sequences: name some, or --list")
    return [
        {
            "build": build,
            "sequence": name,
            "draw": draw,
            "every": 1 if sequences.recorded(name) else options.every,
            "seed": seed,
            "variant": variant.name,
            "mode": variant.mode,
            "settings": variant.settings,
            "execution": "realtime" if options.realtime else options.execution,
        }
        for name in names
        for draw in sequences.draws(name, options.draws)
        for seed in range(options.runs)
        for variant in variants
    ]


def earlier_runs(file: Path | None) -> list[dict[str, Any]]:
    """The runs a JSON file holds. Raises ValueError."""
    if file is None or not file.exists():
        return []
    try:
        found: list[dict[str, Any]] = json.loads(file.read_text())["runs"]
    except (json.JSONDecodeError, KeyError, TypeError) as error:
        raise ValueError(f"{file} is no file of this program: give another --json") from error
    return found


def write(file: Path | None, document: dict[str, Any]) -> None:
    """As a whole or not at all, since a long measurement may be stopped at any time."""
    if file is not None:
        partial = file.with_name(f"{file.name}.partial")
        partial.write_text(json.dumps(document, indent=1) + "\n")
        partial.replace(file)


def one_run(program: list[str], key: dict[str, Any], sequences: Sequences) -> dict[str, Any]:
    """Makes and measures the run. Raises RuntimeError."""
    folder = sequences.folder(key["sequence"], key["draw"])
    variant = Variant(key["variant"], key["mode"], key["settings"])
    with tempfile.TemporaryDirectory(prefix="vsgraphs-ablation-") as temporary:
        case = Case(folder, key["execution"])
        return {"key": key, **measure(program, case, key["seed"], variant, Path(temporary) / "out")}


def main() -> int:
    """Measures, writes JSON after each run, prints tables."""
    options = arguments()
    program = [options.vsgraphs]
    data = os.environ.get("VSGRAPHS_DATA")
    sequences = Sequences(program, Path(data) if data else None, options.cache, options.every)
    try:
        rows = earlier_runs(options.json)
        keys = keys_of(options, variants_of(options), sequences, build_of(options.vsgraphs))
    except (ValueError, RuntimeError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    failures = 0
    for number, key in enumerate(keys, 1):
        name = (
            f"[{number}/{len(keys)}] {key['sequence']} draw {key['draw']} seed {key['seed']} {key['variant']}"
        )
        if any(row["key"] == key for row in rows):
            continue
        try:
            rows.append(one_run(program, key, sequences))
        except RuntimeError as error:
            failures += 1
            print(f"{name}: failed: {error}", file=sys.stderr, flush=True)
            continue
        ate = rows[-1]["figures"].get("ate_rmse_m")
        print(f"{name}: ATE {'-' if ate is None else f'{ate:.4f} m'}", file=sys.stderr, flush=True)
        write(options.json, {"runs": rows})
    return report(options, keys, rows, failures)


def report(
    options: argparse.Namespace, keys: list[dict[str, Any]], rows: list[dict[str, Any]], failures: int
) -> int:
    """Tables and JSON of the runs asked for; returns the exit code."""
    shown = [row for key in keys for row in rows if row["key"] == key]
    if shown:
        print(f"build {keys[0]['build']}, {keys[0]['execution']}, medians\n\n{accuracy_table(shown)}")
        print(f"\n{figures_table(shown)}")
        print(
            f"\nGain of ATE over {options.baseline}, pair by pair\n\n{gains_table(shown, options.baseline)}"
        )
        write(options.json, {"runs": rows, "summary": summary(shown, options.baseline)})
    if failures:
        print(f"{failures} of {len(keys)} runs failed and are in no table", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
