"""Statistics of an ablation: medians, gains of paired runs, their mean over sequences and its interval."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from sequence_figures import Figures

Row = dict[
    str, Any
]  # one run: {"key": {"sequence", "draw", "seed", "variant", ...}, "figures": Figures, ...}

# Student's t, two-sided 95 %, for 1 to 9 degrees of freedom; with more the series below is exact to 1e-4.
_T_95 = (12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060, 2.2622)
_Z_95 = 1.959964


@dataclass(frozen=True)
class Interval:
    """A mean and its 95 % confidence interval; low and high are None for fewer than two values."""

    mean: float
    low: float | None
    high: float | None


@dataclass(frozen=True)
class Gains:
    """What a variant gains over the baseline. sequences: name -> gains of its pairs, by draw and seed."""

    variant: str
    sequences: dict[str, list[float]]

    def means(self) -> dict[str, float]:
        """Mean gain of each sequence."""
        return {name: statistics.fmean(gains) for name, gains in self.sequences.items()}

    def overall(self) -> Interval | None:
        """Each sequence counts once, however many runs it has. None without pairs."""
        means = list(self.means().values())
        return mean_interval(means) if means else None

    def worst(self) -> str | None:
        """The sequence with the smallest mean gain."""
        means = self.means()
        return min(means, key=lambda name: means[name]) if means else None


def t_95(freedom: int) -> float:
    """Two-sided 95 % quantile of Student's t (Cornish-Fisher series; Abramowitz and Stegun 26.7.5)."""
    if freedom < 1:
        raise ValueError(f"{freedom} degrees of freedom")
    if freedom <= len(_T_95):
        return _T_95[freedom - 1]
    z = _Z_95
    terms: tuple[float, ...] = (
        (z**3 + z) / 4,
        (5 * z**5 + 16 * z**3 + 3 * z) / 96,
        (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384,
        (79 * z**9 + 776 * z**7 + 1482 * z**5 - 1920 * z**3 - 945 * z) / 92160,
    )
    beyond: float = sum(term / freedom ** (i + 1) for i, term in enumerate(terms))
    return z + beyond


def mean_interval(values: Sequence[float]) -> Interval:
    """Mean with Student's 95 % interval, as of independent values."""
    mean = statistics.fmean(values)
    if len(values) < 2:
        return Interval(mean, None, None)
    half = t_95(len(values) - 1) * statistics.stdev(values) / math.sqrt(len(values))
    return Interval(mean, mean - half, mean + half)


def gains(rows: list[Row], variant: str, baseline: str, figure: str = "ate_rmse_m") -> Gains:
    """1 - variant / baseline of each pair of runs of one sequence, draw and seed that both have."""
    found: dict[str, list[float]] = {}
    base = {_pair(row): row["figures"] for row in rows if row["key"]["variant"] == baseline}
    own = [row for row in rows if row["key"]["variant"] == variant]
    for row in sorted(own, key=lambda row: _pair(row)[1:]):
        other = base.get(_pair(row), {}).get(figure)
        if figure in row["figures"] and other is not None and other > 0:
            found.setdefault(row["key"]["sequence"], []).append(1 - row["figures"][figure] / other)
    order = names(rows)
    return Gains(variant, {name: found[name] for name in order if name in found})


def _pair(row: Row) -> tuple[str, int, int]:
    key = row["key"]
    return key["sequence"], key["draw"], key["seed"]


def names(rows: list[Row], what: str = "sequence") -> list[str]:
    """Sequences (or variants) in the order of their first run."""
    return list(dict.fromkeys(row["key"][what] for row in rows))


def of(rows: list[Row], sequence: str, variant: str) -> list[Figures]:
    """Figures of the runs of one cell."""
    wanted = (sequence, variant)
    return [row["figures"] for row in rows if (row["key"]["sequence"], row["key"]["variant"]) == wanted]


def medians(runs: list[Figures], keys: Sequence[str]) -> Figures:
    """Median of each figure over the runs that have it; of completion the lowest, lest a lost run hide."""
    return {
        key: (min if key == "completion" else statistics.median)(run[key] for run in runs if key in run)
        for key in keys
        if any(key in run for run in runs)
    }
