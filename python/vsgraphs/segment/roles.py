"""What a surface is to the scene: the values a segmentation image holds."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from enum import IntEnum
from typing import Any

import numpy as np
import numpy.typing as npt

from vsgraphs.errors import InputError
from vsgraphs.reading import shown


class SurfaceRole(IntEnum):
    """As `SurfaceRole` of the core (core/map/surface_patch.h), value for value.

    `undecided` is no vote at all; `other` is a vote for furniture, people, anything a map's structure is not
    made of.
    """

    undecided = 0
    wall = 1
    ground = 2
    ceiling = 3
    door = 4
    window = 5
    other = 6


_BY_CLASS_NAME = {
    **{role.name: role for role in SurfaceRole},
    "void": SurfaceRole.undecided,
    "ignore": SurfaceRole.undecided,
    "unlabeled": SurfaceRole.undecided,
    "floor": SurfaceRole.ground,
    "rug": SurfaceRole.ground,
    "carpet": SurfaceRole.ground,
    "windowpane": SurfaceRole.window,
}


def role_named(name: Any, where: str) -> SurfaceRole:
    """'wall' -> SurfaceRole.wall. Raises InputError that begins with `where` and names the nearest role."""
    names = [role.name for role in SurfaceRole]
    if isinstance(name, str) and name in names:
        return SurfaceRole[name]
    near = get_close_matches(name, names, n=1, cutoff=0.5) if isinstance(name, str) else []
    hint = f"did you mean '{near[0]}'?" if near else f"roles are {', '.join(names)}"
    raise InputError(f"{where}: there is no role {shown(name)}; {hint}")


def role_of_class(name: str) -> SurfaceRole:
    """The role a class name speaks for: 'floor' and 'rug' are ground, 'void' is undecided, 'table' other.

    Synonyms may follow a comma or semicolon (ADE20K: 'windowpane, window'), a kind may follow a dash (COCO:
    'wall-brick', 'floor-other-merged').
    """
    for synonym in name.lower().replace(";", ",").split(","):
        role = _BY_CLASS_NAME.get(synonym.strip().partition("-")[0])
        if role is not None:
            return role
    return SurfaceRole.other


class RoleTable:
    """Class values of an image -> roles.

    count: classes 0 .. count-1 are known, as are those `roles` names; any other value is an error then: the
    image is not of these classes. None: all values are known. A known class without a role is `other`.
    """

    def __init__(self, roles: Mapping[int, SurfaceRole], where: str, count: int | None = None) -> None:
        self._where = where
        self._count = count
        self._size = max([*roles, (count or 0) - 1, 0]) + 1
        self._table = np.full(self._size, SurfaceRole.other, np.uint8)
        self._known = np.zeros(self._size, bool)
        self._known[: count or 0] = True
        for value, role in roles.items():
            self._table[value] = role
            self._known[value] = True

    def check_count(self, count: int) -> None:
        """Raises InputError if a network that tells `count` classes apart is not of these classes."""
        if self._count is not None and count != self._count:
            raise InputError(
                f"{self._where}: {self._count} classes are listed, but the network gives {count}"
            )
        if self._count is None and self._size > max(count, 1):
            raise InputError(
                f"{self._where}: class {self._size - 1} has a role, but the network gives {count} classes"
            )

    def roles(self, classes: npt.NDArray[Any]) -> npt.NDArray[np.uint8]:
        """Roles of an array of class values, same shape. Raises InputError for values that are no class."""
        values = classes.astype(np.int64)
        low, high = (int(values.min()), int(values.max())) if values.size else (0, 0)
        if low < 0:
            raise InputError(f"{self._where}: class {low} in the image is negative")
        if self._count is None:
            named = self._table[np.minimum(values, self._size - 1)]
            return np.where(values < self._size, named, np.uint8(SurfaceRole.other))
        within = np.minimum(values, self._size - 1)
        if high >= self._size or not self._known[within].all():
            stray = values[(values >= self._size) | ~self._known[within]].min()
            raise InputError(f"{self._where}: class {stray} is in the image, but not listed")
        return self._table[values]
