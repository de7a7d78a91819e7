"""A segmenter's own classes (table, picture, person), beside the roles they stand for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from vsgraphs.errors import InputError
from vsgraphs.reading import shown

LONGEST_NAME = 128  # bytes of UTF-8
MOST_NAMES = 65535
# What networks and label folders call what has no class.
_NO_CLASS = frozenset({"undecided", "void", "ignore", "unlabeled", "unlabelled", "background"})


def check_names(names: Any, where: str) -> tuple[str, ...]:
    """`names` as the core takes them. Raises InputError that begins with `where`."""
    if isinstance(names, str) or not isinstance(names, Sequence):
        raise InputError(f"{where} must be a list of names, class k is the k-th, not {type(names).__name__}")
    if len(names) > MOST_NAMES:
        raise InputError(f"{where}: {len(names)} names; at most {MOST_NAMES} can be told apart")
    seen = set[str]()
    for name in names:
        check_name(name, where)
        if name in seen:
            raise InputError(f"{where}: the name {shown(name)} is there twice")
        seen.add(name)
    return tuple(names)


def check_name(name: Any, where: str) -> None:
    """Raises InputError that begins with `where` for what cannot be a class's name."""
    if not isinstance(name, str):
        raise InputError(f"{where}: {shown(name)} is no name, expected a text")
    try:
        size = len(name.encode())
    except UnicodeEncodeError:  # half of a surrogate pair
        size = 0
    if not 1 <= size <= LONGEST_NAME or any(c < " " or c == "\x7f" for c in name):
        raise InputError(
            f"{where}: the name {shown(name)} must be a text of 1 to {LONGEST_NAME} bytes (UTF-8) "
            "without control characters"
        )


class ClassTable:
    """Class values of an image -> numbers of classes: k for the k-th of `names`, 0 where a value's name says
    that there is no class ("void", "background").
    """

    def __init__(self, names: Mapping[int, str], where: str) -> None:
        named = {value: name for value, name in sorted(names.items()) if name.lower() not in _NO_CLASS}
        self.names = check_names(list(named.values()), where)
        self._table = np.zeros(max(names, default=0) + 1, np.uint16)
        self._table[list(named)] = np.arange(1, len(named) + 1)

    def classes(self, values: npt.NDArray[Any]) -> npt.NDArray[np.uint16]:
        """(h, w) of class values, none of them beyond the table's -> (h, w) uint16."""
        classes: npt.NDArray[np.uint16] = self._table[values.astype(np.int64)]
        return classes
