"""The tables of an ablation, in Markdown, and its summary for JSON."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from ablation_sequences import ORB_SLAM3_ATE_M
from ablation_statistics import Gains, Row, gains, medians, names, of

# Figure -> (heading, digits). Components are walls and ground together; near: of the points at most 0.3 m
# from a true surface.
COLUMNS = {
    "ate_rmse_m": ("ATE m", 4),
    "completion": ("lowest completion", 3),
    "map_points": ("points", 0),
    "map_rmse_m": ("map RMSE m", 3),
    "map_near_rmse_m": ("near m", 3),
    "precision": ("precision", 2),
    "recall": ("recall", 2),
    "f1": ("F1", 2),
    "angle_deg": ("angle deg", 2),
    "offset_m": ("offset m", 3),
    "cpu_s_per_1000": ("CPU ms / frame", 2),
    "peak_memory_mb": ("memory MB", 0),
    "dropped": ("dropped", 0),
}


def accuracy_table(rows: list[Row]) -> str:
    """Median ATE of each sequence and variant, ORB-SLAM3's beside them."""
    variants = names(rows, "variant")
    lines = _head(["sequence", "ORB-SLAM3 ATE m", *(f"{variant} ATE m" for variant in variants)])
    for name in names(rows):
        cells = [_published(name)]
        for variant in variants:
            ate = medians(of(rows, name, variant), ["ate_rmse_m"]).get("ate_rmse_m")
            cells.append("-" if ate is None else f"{ate:.4f}")
        lines.append(_line([name, *cells]))
    return "\n".join(lines)


def _published(name: str) -> str:
    low, high = ORB_SLAM3_ATE_M.get(name, (None, None))
    if low is None:
        return "-"
    return f"{low:g}" if low == high else f"{low:g}-{high:g}"


def figures_table(rows: list[Row]) -> str:
    """Medians of every figure that any run has, a line for each sequence and variant."""
    keys = [key for key in COLUMNS if any(key in row["figures"] for row in rows)]
    lines = _head(["sequence", "variant", "runs", *(COLUMNS[key][0] for key in keys)], words=2)
    for name in names(rows):
        for variant in names(rows, "variant"):
            runs = of(rows, name, variant)
            if runs:
                found = medians(runs, keys)
                cells = [f"{found[key]:.{COLUMNS[key][1]}f}" if key in found else "-" for key in keys]
                lines.append(_line([name, variant, str(len(runs)), *cells]))
    return "\n".join(lines)


def gains_table(rows: list[Row], baseline: str) -> str:
    """Mean gain of ATE over the baseline for each sequence (worst pair, pairs), then over sequences."""
    every = [found for found in all_gains(rows, baseline) if found.sequences]
    if not every:
        return f"no run of any variant has its pair among those of {baseline}"
    lines = _head(["sequence", *(found.variant for found in every)])
    for name in names(rows):
        cells = [_cell(found.sequences.get(name, [])) for found in every]
        lines.append(_line([name, *cells]))
    lines.append(_line(["**mean of sequences**", *(_mean(found) for found in every)]))
    lines.append(_line(["95 % interval", *(_interval(found) for found in every)]))
    lines.append(_line(["worst sequence", *(str(found.worst()) for found in every)]))
    return "\n".join(lines)


def all_gains(rows: list[Row], baseline: str) -> list[Gains]:
    """Of each variant but the baseline."""
    return [gains(rows, variant, baseline) for variant in names(rows, "variant") if variant != baseline]


def _cell(values: list[float]) -> str:
    if not values:
        return "-"
    return f"{_percent(sum(values) / len(values))} (worst {_percent(min(values))} of {len(values)})"


def _mean(found: Gains) -> str:
    overall = found.overall()
    return "-" if overall is None else _percent(overall.mean)


def _interval(found: Gains) -> str:
    overall = found.overall()
    if overall is None or overall.low is None or overall.high is None:
        return "needs two sequences"
    return f"{_percent(overall.low)} to {_percent(overall.high)}"


def _percent(share: float) -> str:
    return f"{100 * share:+.1f} %"


def _head(cells: list[str], words: int = 1) -> list[str]:
    return [_line(cells), "|" + "---|" * words + "---:|" * (len(cells) - words)]


def _line(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def summary(rows: list[Row], baseline: str) -> dict[str, Any]:
    """What the tables show, for JSON."""
    cells = {
        name: {
            variant: {"runs": len(runs), **medians(runs, list(COLUMNS))}
            for variant in names(rows, "variant")
            if (runs := of(rows, name, variant))
        }
        for name in names(rows)
    }
    found = {}
    for each in all_gains(rows, baseline):
        overall = each.overall()
        found[each.variant] = {
            "overall": None if overall is None else asdict(overall),
            "worst": each.worst(),
            "means": each.means(),
            "pairs": each.sequences,
        }
    return {"medians": cells, "baseline": baseline, "ate_gains": found}
