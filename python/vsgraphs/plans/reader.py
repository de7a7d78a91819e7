"""JSON values into the core's plan objects, by the tables of schema.py."""

from __future__ import annotations

import math
from difflib import get_close_matches
from typing import Any

from vsgraphs.compiled import core
from vsgraphs.errors import InputError
from vsgraphs.plans.schema import CAMERA_KEYS, COMMENT, Table
from vsgraphs.reading import shortened, shown

_LONGEST_NAME = 100
_MAX_SEED = 2**63 - 1


class Reader:
    """Turns JSON values into the core's values; every failure names the key."""

    def __init__(self, source: str) -> None:
        self._source = source

    def _fail(self, key: str, message: str) -> InputError:
        key = shortened(key, 120)
        return InputError(f"{self._source}: {key}: {message}" if key else f"{self._source}: {message}")

    def table(self, table: Table, value: object, key: str, also: tuple[str, ...] = ()) -> Any:
        """An object of the plan; `also` lists keys somebody else reads, for suggestions."""
        if not isinstance(value, dict):
            raise self._fail(key, f"expected an object {{...}}, not {shown(value)}")
        made = getattr(core(), table.cls)()
        prefix = f"{key}." if key else ""
        for name, item in value.items():
            if name == COMMENT:
                continue
            if name not in table.keys:
                self._unknown(prefix + name, name, (*table.keys, *also))
            attribute = table.names.get(name, name)
            setattr(made, str(attribute), self._value(table.keys[name], item, prefix + name))
        for name in table.required:
            if name not in value:
                raise self._fail(key, f'"{name}" is missing')
        return made

    def _unknown(self, key: str, name: str, known: tuple[str, ...]) -> None:
        near = get_close_matches(name, known, n=1, cutoff=0.6)
        hint = f"did you mean '{near[0]}'?" if near else f"known: {', '.join(known)}"
        raise self._fail(key, f"unknown key; {hint}")

    def _value(self, kind: str | Table | list[Table], value: object, key: str) -> Any:
        if isinstance(kind, Table):
            return self.table(kind, value, key)
        if isinstance(kind, list):
            items = self._list(value, key, "a list of objects")
            return [self.table(kind[0], item, f"{key}[{i}]") for i, item in enumerate(items)]
        return self.number(value, key) if kind == "number" else getattr(self, f"_{kind}")(value, key)

    def _list(self, value: object, key: str, expected: str) -> list[object]:
        if not isinstance(value, list | tuple):
            raise self._fail(key, f"expected {expected}, not {shown(value)}")
        return list(value)

    def number(self, value: object, key: str) -> float:
        """A finite number."""
        if isinstance(value, bool) or not isinstance(value, int | float) or not _fits(value):
            raise self._fail(key, f"expected a finite number, not {shown(value)}")
        return float(value)

    def _whole(self, value: object, key: str) -> int:
        number = self.number(value, key)
        limit = _MAX_SEED if key.endswith("seed") else 10**6
        if number != int(number) or abs(number) > limit or (key.endswith("seed") and number < 0):
            raise self._fail(key, f"expected a whole number, not {shown(value)}")
        return int(number)

    def _text(self, value: object, key: str) -> str:
        if not isinstance(value, str):
            raise self._fail(key, f"expected text, not {shown(value)}")
        if key != "description" and (len(value) > _LONGEST_NAME or not value.isprintable()):
            raise self._fail(
                key, f"expected one line of at most {_LONGEST_NAME} characters, not {shown(value)}"
            )
        return value

    def _flag(self, value: object, key: str) -> bool:
        if not isinstance(value, bool):
            raise self._fail(key, f"expected true or false, not {shown(value)}")
        return value

    def _numbers(self, value: object, key: str, count: int) -> list[float]:
        items = self._list(value, key, f"{count} numbers")
        if len(items) != count:
            raise self._fail(key, f"expected {count} numbers, not {len(items)}")
        return [self.number(item, f"{key}[{i}]") for i, item in enumerate(items)]

    def _point(self, value: object, key: str) -> list[float]:
        return self._numbers(value, key, 2)

    def _size(self, value: object, key: str) -> list[float]:
        return self._numbers(value, key, 3)

    def _points(self, value: object, key: str) -> list[list[float]]:
        return [
            self._point(item, f"{key}[{i}]")
            for i, item in enumerate(self._list(value, key, "a list of points"))
        ]

    def _texts(self, value: object, key: str) -> list[str]:
        return [
            self._text(item, f"{key}[{i}]")
            for i, item in enumerate(self._list(value, key, "a list of names"))
        ]

    def _colour(self, value: object, key: str) -> list[int]:
        expected = f'expected "#rrggbb", not {shown(value)}'
        if not isinstance(value, str) or len(value) != 7 or value[0] != "#":
            raise self._fail(key, expected)
        try:
            return [int(value[i : i + 2], 16) for i in (1, 3, 5)]
        except ValueError:
            raise self._fail(key, expected) from None

    def text(self, value: object, key: str) -> str:
        """One line of text."""
        return self._text(value, key)

    def effects(self, value: object) -> dict[str, object]:
        """Effects of the camera by name; their names and ranges are the simulator's to check."""
        if not isinstance(value, dict):
            raise self._fail("effects", f"expected an object {{...}}, not {shown(value)}")
        return {name: item for name, item in value.items() if name != COMMENT}

    def camera(self, value: object) -> dict[str, float]:
        """The camera's size and focal lengths; empty if the plan leaves them to us."""
        if not isinstance(value, dict):
            raise self._fail("camera", f"expected an object {{...}}, not {shown(value)}")
        for name in value:
            if name not in CAMERA_KEYS and name != COMMENT:
                self._unknown(f"camera.{name}", name, CAMERA_KEYS)
        read: dict[str, float] = {}
        for name, item in value.items():
            if name != COMMENT:
                kind = self._whole if name in ("width", "height") else self.number
                read[name] = kind(item, f"camera.{name}")
        if read and set(read) != set(CAMERA_KEYS):
            missing = ", ".join(name for name in CAMERA_KEYS if name not in read)
            raise self._fail("camera", f"give all of {', '.join(CAMERA_KEYS)} or none; missing: {missing}")
        return read


def _fits(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number of hundreds of digits
        return False
