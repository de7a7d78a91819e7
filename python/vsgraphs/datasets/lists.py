"""Lists of timed files (rgb.txt, associations.txt) and their repair."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Generic, TypeVar

from vsgraphs.errors import InputError
from vsgraphs.reading import LARGE, read_text, shown

T = TypeVar("T")

# A list whose order loses more than this share of its frames is sorted instead: it was never in order of
# time.
_UNSORTED_SHARE = 0.1
LATEST_S = 1e11  # the core takes no later one; nanoseconds since 1970 are beyond it


@dataclass
class Timed(Generic[T]):
    """Items with strictly increasing timestamps, and what had to go to make them so."""

    stamps: list[float]
    items: list[T]
    skipped: dict[str, int] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)


def in_order(stamps: list[float], items: list[T], source: str) -> Timed[T]:
    """Makes timestamps strictly increasing.

    Frames without a timestamp in seconds, at most `LATEST_S`, are skipped. A frame whose timestamp repeats or
    goes back is skipped; but when that would cost more than a tenth of the list, the list was not in order of
    time: it is sorted, and only repeated timestamps are skipped.
    """
    out: Timed[T] = Timed([], [])
    pairs = zip(stamps, items, strict=True)
    finite = [(stamp, item) for stamp, item in pairs if abs(stamp) <= LATEST_S]  # false for NaN
    _count(
        out,
        "not_finite_timestamp",
        len(stamps) - len(finite),
        f"{source}: {{}} timestamps that are no number of seconds",
    )
    kept = _increasing(finite)
    if len(finite) - len(kept) > max(1.0, _UNSORTED_SHARE * len(finite)):
        ordered = sorted(finite, key=lambda pair: pair[0])
        if ordered != finite:
            out.warnings.append(f"{source}: not in order of time, sorted")
        kept = _increasing(ordered)
        _count(out, "repeated_timestamp", len(finite) - len(kept), f"{source}: {{}} repeated timestamps")
    else:
        lost = len(finite) - len(kept)
        _count(out, "repeated_or_backward_timestamp", lost, f"{source}: {{}} repeated or backward timestamps")
    out.stamps = [stamp for stamp, _ in kept]
    out.items = [item for _, item in kept]
    return out


def _increasing(pairs: list[tuple[float, T]]) -> list[tuple[float, T]]:
    kept: list[tuple[float, T]] = []
    for pair in pairs:
        if not kept or pair[0] > kept[-1][0]:
            kept.append(pair)
    return kept


def _count(out: Timed[T], reason: str, count: int, message: str) -> None:
    if count:
        out.skipped[reason] = out.skipped.get(reason, 0) + count
        out.warnings.append(message.format(count) + ", skipped")


def read_list(path: Path, fields: int) -> list[list[str]]:
    """Rows of a list file, comments and blank lines left out. Every row has at least `fields` fields."""
    text = read_text(path, "list", LARGE, damaged=True)
    rows = []
    for number, line in enumerate(text.splitlines(), 1):
        words = line.split("#", 1)[0].replace(",", " ").split()
        if not words:
            continue
        if len(words) < fields:
            raise InputError(
                f"{path}:{number}: {len(words)} fields in {shown(line.strip())}, expected {fields}"
            )
        rows.append(words)
    return rows


def stamp_of(word: str, path: Path) -> float:
    """A timestamp field in seconds; NaN is allowed here and dealt with by `in_order`."""
    try:
        return float(word)
    except ValueError:
        raise InputError(f"{path}: timestamp {shown(word)} is not a number") from None


def read_timed_files(path: Path) -> Timed[str]:
    """rgb.txt or depth.txt (`timestamp file` per line), in order. Raises InputError if nothing is usable."""
    rows = read_list(path, 2)
    if not rows:
        raise InputError(f"{path} lists no images; expected lines 'timestamp file'")
    timed = in_order([stamp_of(row[0], path) for row in rows], [row[1] for row in rows], path.name)
    if not timed.stamps:
        raise InputError(f"{path}: none of the {len(rows)} timestamps is a number of seconds")
    return timed
