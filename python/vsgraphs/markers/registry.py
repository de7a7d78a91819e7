"""The marker file: which dictionary, how large, and what each marker names."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.reading import read_json, shortened, shown

KINDS = ("room", "corridor", "door")
# Name -> how many markers it holds.
DICTIONARIES = {
    **{f"{side}x{side}_{count}": count for side in (4, 5, 6, 7) for count in (50, 100, 250, 1000)},
    "aruco_original": 1024,
    "aruco_mip_36h12": 250,
    "apriltag_16h5": 30,
    "apriltag_25h9": 35,
    "apriltag_36h10": 2320,
    "apriltag_36h11": 587,
}
_KEYS = ("dictionary", "size_m", "markers")
_MARKER_KEYS = ("name", "kind", "size_m")
_LARGEST_M = 10.0


@dataclass(frozen=True)
class NamedMarker:
    """What a marker stands for. kind: one of KINDS; size_m: of its black square."""

    name: str
    kind: str
    size_m: float


@dataclass(frozen=True)
class MarkerRegistry:
    """A marker file. dictionary: a key of DICTIONARIES; size_m: of markers that do not say theirs."""

    dictionary: str
    size_m: float
    markers: dict[int, NamedMarker] = field(default_factory=dict)

    def size_of(self, number: int) -> float:
        """Side of the black square of marker `number`, named or not."""
        named = self.markers.get(number)
        return self.size_m if named is None else named.size_m


def load_markers(path: Path) -> MarkerRegistry:
    """Reads a marker file (docs/markers.md). Raises InputError, which names the file and the key."""
    return _Reader(str(path)).registry(read_json(path, "marker file", unique=True))


class _Reader:
    def __init__(self, source: str) -> None:
        self._source = source

    def registry(self, values: object) -> MarkerRegistry:
        table = self._table(values, "", _KEYS, ("dictionary", "size_m", "markers"))
        dictionary = self._one_of(table["dictionary"], "dictionary", tuple(DICTIONARIES))
        size_m = self._size(table["size_m"], "size_m")
        if not isinstance(table["markers"], dict):
            raise self._wrong("markers", 'expected an object {"7": {"name": ..., "kind": ...}, ...}')
        markers: dict[int, NamedMarker] = {}
        for key, row in table["markers"].items():
            number = self._number(key, dictionary)
            if number in markers:
                raise self._wrong(f"markers.{key}", f"marker {number} is there twice")
            markers[number] = self._marker(row, f"markers.{key}", size_m)
        return MarkerRegistry(dictionary, size_m, dict(sorted(markers.items())))

    def _marker(self, value: object, key: str, size_m: float) -> NamedMarker:
        row = self._table(value, key, _MARKER_KEYS, ("name", "kind"))
        name = row["name"]
        if not isinstance(name, str) or not name.strip():
            raise self._wrong(f"{key}.name", f"expected a name, not {shown(name)}")
        kind = self._one_of(row["kind"], f"{key}.kind", KINDS)
        return NamedMarker(name.strip(), kind, self._size(row.get("size_m", size_m), f"{key}.size_m"))

    def _number(self, key: str, dictionary: str) -> int:
        count = DICTIONARIES[dictionary]
        if not (key.isascii() and key.isdecimal()) or len(key) > 9 or int(key) >= count:
            raise self._wrong(f"markers.{key}", f"no marker of {dictionary}, whose ids are 0 to {count - 1}")
        return int(key)

    def _table(
        self, value: object, key: str, known: tuple[str, ...], needed: tuple[str, ...]
    ) -> dict[str, Any]:
        if not isinstance(value, dict):
            raise self._wrong(key, f"expected an object, not {shown(value)}")
        prefix = f"{key}." if key else ""
        for name in value:
            if name not in known:
                near = get_close_matches(name, known, n=1, cutoff=0.6)
                hint = f"did you mean '{near[0]}'?" if near else f"known: {', '.join(known)}"
                raise self._wrong(prefix + name, f"unknown key; {hint}")
        for name in needed:
            if name not in value:
                raise self._wrong(key, f'"{name}" is missing')
        return value

    def _one_of(self, value: object, key: str, known: tuple[str, ...]) -> str:
        if isinstance(value, str) and value in known:
            return value
        near = get_close_matches(value.lower(), known, n=1, cutoff=0.5) if isinstance(value, str) else []
        hint = f"did you mean '{near[0]}'? " if near else ""
        raise self._wrong(
            key, f"unknown {key.rpartition('.')[2]} {shown(value)}; {hint}known: {', '.join(known)}"
        )

    def _size(self, value: object, key: str) -> float:
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not number or not math.isfinite(value) or not 0 < value <= _LARGEST_M:  # type: ignore[operator, arg-type]
            raise self._wrong(key, f"expected the black square's side in metres, not {shown(value)}")
        return float(value)  # type: ignore[arg-type]

    def _wrong(self, key: str, message: str) -> InputError:
        key = shortened(key, 120)
        return InputError(f"{self._source}: {key}: {message}" if key else f"{self._source}: {message}")
