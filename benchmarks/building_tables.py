"""The tables of a run over buildings, in Markdown: each run, then median and worst over the draws."""

from __future__ import annotations

import statistics
from typing import Any

Row = dict[str, Any]  # {"key": {"place", "draw", "seed", "variant", ...}, "figures": {...}}

# What was found of the rooms, say: (found, true, false).
FOUND = ("rooms", "doors", "walls")
_HEADS = ("ATE m", "complete %", "maps", "loops", "merges")
_FOUND_HEADS = tuple(f"{kind} found/true (false)" for kind in FOUND)


def runs_table(rows: list[Row]) -> str:
    """A line for each run."""
    heads = ["place", "variant", "draw", "seed", *_HEADS, *_FOUND_HEADS, "frames", "CPU s"]
    lines = _head(heads, words=2)
    for row in rows:
        key, figures = row["key"], row["figures"]
        cells = [key["place"], key["variant"], str(key["draw"]), str(key["seed"])]
        cells += [_ate(figures["ate_rmse_m"]), f"{100 * figures['completion']:.1f}"]
        cells += [_whole(figures[name]) for name in ("maps", "loops", "merges")]
        cells += [_found(figures[kind]) for kind in FOUND]
        lines.append(_line([*cells, _whole(figures["frames"]), f"{figures['cpu_s']:.1f}"]))
    return "\n".join(lines)


def draws_table(rows: list[Row]) -> str:
    """A line for each place and variant: median / worst of its draws and seeds."""
    heads = ["place", "variant", "runs", *_HEADS, *(f"{kind} missed (false)" for kind in FOUND), "CPU s"]
    lines = _head(heads, words=2)
    for place, variant in dict.fromkeys((row["key"]["place"], row["key"]["variant"]) for row in rows):
        runs = [
            row["figures"] for row in rows if (row["key"]["place"], row["key"]["variant"]) == (place, variant)
        ]
        ates = [run["ate_rmse_m"] for run in runs if run["ate_rmse_m"] is not None]
        shares = [100 * run["completion"] for run in runs]
        cells = [place, variant, str(len(runs))]
        cells.append(f"{_ate(statistics.median(ates))} / {_ate(max(ates))}" if ates else "-")
        cells.append(f"{statistics.median(shares):.1f} / {min(shares):.1f}")
        cells += [_both([run[name] for run in runs]) for name in ("maps", "loops", "merges")]
        cells += [_missed([run[kind] for run in runs]) for kind in FOUND]
        lines.append(_line([*cells, _both([run["cpu_s"] for run in runs])]))
    return "\n".join(lines)


def _ate(metres: float | None) -> str:
    return "-" if metres is None else f"{metres:.4f}"


def _whole(number: float) -> str:
    return f"{number:.0f}"


def _both(numbers: list[float]) -> str:
    return f"{round(statistics.median(numbers), 1):g} / {round(max(numbers), 1):g}"


def _found(score: dict[str, int] | None) -> str:
    return "-" if score is None else f"{score['found']}/{score['true']} ({score['false']})"


def _missed(scores: list[dict[str, int] | None]) -> str:
    known = [score for score in scores if score is not None]
    if not known:
        return "-"
    missed = [score["true"] - score["found"] for score in known]
    false = [score["false"] for score in known]
    return f"{statistics.median(missed):g} / {max(missed)} ({statistics.median(false):g} / {max(false)})"


def _head(cells: list[str], words: int) -> list[str]:
    return [_line(cells), "|" + "---|" * words + "---:|" * (len(cells) - words)]


def _line(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |"
