"""Pairing two lists of timestamps."""

from __future__ import annotations

import numpy as np

_CANDIDATES = 32  # so that a generous gap does not make all pairs of all


def pair_by_time(first: list[float], second: list[float], max_gap_s: float) -> list[tuple[int, int]]:
    """One-to-one pairs (i, j) of nearest timestamps at most `max_gap_s` apart, the closest served first.

    Both lists ascending, seconds. Returns pairs in order of i. Of each timestamp the nearest 32 before and
    after it are candidates. Cost: n log n.
    """
    a, b = np.asarray(first), np.asarray(second)
    if not len(a) or not len(b):
        return []
    nearest = np.searchsorted(b, a)
    low = np.maximum(np.searchsorted(b, a - max_gap_s, side="left"), nearest - _CANDIDATES)
    high = np.minimum(np.searchsorted(b, a + max_gap_s, side="right"), nearest + _CANDIDATES)
    candidates = [
        (abs(first[i] - second[j]), i, j) for i in range(len(a)) for j in range(int(low[i]), int(high[i]))
    ]
    used_first: set[int] = set()
    used_second: set[int] = set()
    pairs = []
    for _, i, j in sorted(candidates):
        if i not in used_first and j not in used_second:
            used_first.add(i)
            used_second.add(j)
            pairs.append((i, j))
    return sorted(pairs)


def smallest_gap(first: list[float], second: list[float]) -> float:
    """The smallest difference between a timestamp of one and of the other list, s; both ascending."""
    a, b = np.asarray(first), np.asarray(second)
    right = np.clip(np.searchsorted(b, a), 0, len(b) - 1)
    left = np.clip(right - 1, 0, len(b) - 1)
    return float(np.minimum(np.abs(b[right] - a), np.abs(b[left] - a)).min())
