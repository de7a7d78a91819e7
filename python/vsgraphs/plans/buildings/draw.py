"""Random choices that stay the same on every machine and Python version."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")


class Draw:
    """A stream of choices. Equal names give equal streams; reading one does not change another.

    Built on `random.Random.random` alone, whose numbers Python promises to keep.
    """

    def __init__(self, *names: str | int) -> None:
        self._random = random.Random("/".join(map(str, names)))  # noqa: S311  (no secret)

    def chance(self, share: float) -> bool:
        """True in `share` of all cases."""
        return self._random.random() < share

    def share(self) -> float:
        """In [0, 1)."""
        return self._random.random()

    def whole(self, below: int) -> int:
        """0 to below - 1."""
        return int(self._random.random() * below)

    def uniform(self, low: float, high: float) -> float:
        """In [low, high), to the millimetre."""
        return round(low + (high - low) * self._random.random(), 3)

    def choose(self, items: Sequence[T]) -> T:
        """One of them."""
        return items[self.whole(len(items))]

    def shuffled(self, items: Sequence[T]) -> list[T]:
        """All of them in another order."""
        left = list(items)
        return [left.pop(self.whole(len(left))) for _ in items]

    def seed(self) -> int:
        """Of a texture."""
        return 1 + self.whole(1_000_000)
