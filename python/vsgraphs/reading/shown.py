"""Values in messages: one line, and short, whatever the value is."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any

_FEW = 4  # items shown of a list


def shortened(text: str, limit: int = 80) -> str:
    """One line of at most `limit` characters: the middle goes where it is longer, line ends are escaped."""
    if len(text) > limit:
        head = (limit - 5) * 2 // 3
        text = f"{text[:head]} ... {text[len(text) - (limit - 5 - head) :]}"
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def shown(value: Any, limit: int = 60) -> str:
    """A value as JSON writes it (texts in single quotes), at most about `limit` characters.

    Costs the same for every value: of a list or an object only the first few items are looked at, of those
    within them none.
    """
    return _shown(value, limit, depth=2)


def _shown(value: Any, limit: int, depth: int) -> str:
    if isinstance(value, str):
        return f"'{shortened(value, limit)}'"
    if value is None or isinstance(value, bool):
        return json.dumps(value)
    if isinstance(value, int):
        return _whole(value)
    if isinstance(value, dict):
        pairs = (f"{_shown(k, 20, 0)}: {_shown(v, 20, depth - 1)}" for k, v in value.items())
        return _listed("{}", pairs, len(value), limit, depth)
    if isinstance(value, list | tuple):
        return _listed("[]", (_shown(item, 20, depth - 1) for item in value), len(value), limit, depth)
    text = repr(value) if isinstance(value, float) else f"{type(value).__name__}"
    return shortened(text, limit)


def _whole(value: int) -> str:
    if abs(value) < 10**20:
        return str(value)
    return f"a whole number of {value.bit_length()} bits"  # its digits may be more than Python writes


def _listed(ends: str, items: Iterable[str], count: int, limit: int, depth: int) -> str:
    if depth <= 0 and count:
        return f"{ends[0]}...{ends[1]}"
    first: Iterator[str] = islice(items, _FEW)
    text = ", ".join(first) + (", ..." if count > _FEW else "")
    return f"{ends[0]}{shortened(text, limit)}{ends[1]}"
