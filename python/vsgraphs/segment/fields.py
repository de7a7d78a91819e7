"""Reading a JSON object strictly: a misspelt key is an error that names the nearest one."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from vsgraphs.errors import InputError
from vsgraphs.reading import read_json, shown

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path


def read_object(path: Path, what: str) -> dict[str, Any]:
    """The object in a JSON file. Raises InputError: missing, not JSON, not an object."""
    found = read_json(path, what, unique=True)
    if not isinstance(found, dict):
        raise InputError(f"{what} {path}: expected a JSON object, {{...}}")
    return found


class Fields:
    """The fields of one object. `where` begins every message: the file and the keys that lead here."""

    def __init__(self, data: Any, where: str, known: Sequence[str]) -> None:
        if not isinstance(data, dict):
            raise InputError(f"{where}: expected an object, {{...}}")
        for key in data:
            if key not in known and key != "comment":
                near = get_close_matches(key, known, n=1, cutoff=0.5)
                hint = f"did you mean '{near[0]}'?" if near else f"known are {', '.join(known)}"
                raise InputError(f"{where}: unknown key {shown(key)}; {hint}")
        self._data = data
        self.where = where

    def has(self, key: str) -> bool:
        """Whether the key is there."""
        return key in self._data

    def required(self, key: str) -> Any:
        """A value that must be there."""
        if key not in self._data:
            raise InputError(f"{self.where}: key '{key}' is missing")
        return self._data[key]

    def text(self, key: str) -> str:
        """A text that must be there."""
        value = self.required(key)
        if not isinstance(value, str):
            raise self.wrong(key, "a text")
        return value

    def choice(self, key: str, choices: Sequence[str], default: str | None = None) -> str:
        """One of `choices`."""
        if default is not None and key not in self._data:
            return default
        value = self.required(key)
        if value not in choices:
            near = get_close_matches(value if isinstance(value, str) else "", choices, n=1, cutoff=0.5)
            hint = f"did you mean '{near[0]}'?" if near else f"choose from {', '.join(choices)}"
            raise InputError(f"{self.where}: '{key}' cannot be {shown(value)}; {hint}")
        return str(value)

    def number(self, key: str, default: float) -> float:
        """A number."""
        value = self._data.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.wrong(key, "a number")
        return float(value)

    def share(self, key: str, default: float) -> float:
        """A number from 0 to 1."""
        value = self.number(key, default)
        if not 0 <= value <= 1:
            raise self.wrong(key, "from 0 to 1")
        return value

    def integer(self, key: str, default: int, most: int = 2**31) -> int:
        """An integer from 0 to `most`."""
        value = self._data.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= most:
            raise self.wrong(key, f"an integer from 0 to {most}")
        return value

    def numbers(self, key: str, count: int, default: Sequence[float]) -> tuple[float, ...]:
        """A list of `count` numbers."""
        value = self._data.get(key, list(default))
        if not isinstance(value, list) or len(value) != count or not all(_is_number(v) for v in value):
            raise self.wrong(key, f"a list of {count} numbers")
        return tuple(float(v) for v in value)

    def wrong(self, key: str, expected: str) -> InputError:
        """The error for a value that is not what it should be."""
        return InputError(f"{self.where}: '{key}' must be {expected}, not {shown(self._data.get(key))}")


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
