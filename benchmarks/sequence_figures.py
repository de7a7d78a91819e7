"""The figures of a run of `vsgraphs`, their medians and ratios, and tables of them."""

from __future__ import annotations

import statistics
from typing import Any

# Figure -> (heading, digits). Times in ms of the whole track call, helper threads' CPU included.
COLUMNS = {
    "ate_rmse_m": ("ATE m", 4),
    "completion": ("completion", 4),
    "fps": ("frames/s", 1),
    "track_cpu_median_ms": ("track CPU ms", 2),
    "track_cpu_p95_ms": ("p95", 2),
    "track_median_ms": ("track wall ms", 2),
    "track_p95_ms": ("p95", 2),
    "cpu_s_per_1000": ("CPU s / 1000 frames", 2),
    "peak_memory_mb": ("memory MB", 0),
    "startup_s": ("first pose s", 3),
    "waited_s": ("waited s", 2),
    "dropped": ("dropped", 0),
    "keyframes": ("keyframes", 0),
    "landmarks": ("landmarks", 0),
}

Figures = dict[str, float]


def figures(run: dict[str, Any], evaluation: dict[str, Any]) -> Figures:
    """The numbers of the table from run.json and eval's JSON; without ground truth there is no ATE."""
    found = {
        "completion": run["completion"],
        "cpu_s_per_1000": 1000 * run["cpu_s"] / max(1, run["frames"]),
        "dropped": run["skipped"].get("dropped", 0),
    }
    found |= {key: run[key] for key in COLUMNS if key in run}
    track = run["stages"]["track"]
    found |= {f"track_{key}": track[key] for key in track if f"track_{key}" in COLUMNS}
    if evaluation:
        found["ate_rmse_m"] = evaluation["ate"]["rmse_m"]
        if evaluation["completion"] is not None:
            found["completion"] = evaluation["completion"]
    return {key: float(value) for key, value in found.items() if value is not None}


def medians(runs: list[Figures]) -> Figures:
    """Median of each figure over runs that have it."""
    keys = [key for key in COLUMNS if any(key in run for run in runs)]
    return {key: statistics.median(run[key] for run in runs if key in run) for key in keys}


def ratios(first: list[Figures], second: list[Figures]) -> Figures:
    """Median over pairs of runs of second / first, of figures that are positive in both."""
    found: Figures = {}
    for key in COLUMNS:
        pairs = [(a[key], b[key]) for a, b in zip(first, second, strict=True) if key in a and key in b]
        sound = [b / a for a, b in pairs if a > 0 and b > 0]
        if sound:
            found[key] = statistics.median(sound)
    return found


def table(rows: list[tuple[str, Figures]], digits: int | None = None) -> str:
    """Markdown table of the figures that any row has."""
    keys = [key for key in COLUMNS if any(key in row for _, row in rows)]
    lines = ["| | " + " | ".join(COLUMNS[key][0] for key in keys) + " |", "|---|" + "---:|" * len(keys)]
    for name, row in rows:
        cells = [
            f"{row[key]:.{COLUMNS[key][1] if digits is None else digits}f}" if key in row else "-"
            for key in keys
        ]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def stage_table(runs: list[dict[str, Any]]) -> str:
    """Markdown table of every stage: medians over the runs."""
    kinds = ("count", "median_ms", "p95_ms", "max_ms", "cpu_median_ms", "cpu_p95_ms")
    lines = ["| stage | " + " | ".join(kinds) + " |", "|---|" + "---:|" * len(kinds)]
    for stage in sorted({stage for run in runs for stage in run["stages"]}):
        having = [run["stages"][stage] for run in runs if stage in run["stages"]]
        cells = [statistics.median(float(one[kind]) for one in having) for kind in kinds]
        texts = [f"{cells[0]:.0f}", *(f"{cell:.3f}" for cell in cells[1:])]
        lines.append(f"| {stage} | " + " | ".join(texts) + " |")
    return "\n".join(lines)
