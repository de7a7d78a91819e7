"""Segmentations from a folder of class images: made by a simulator, a person or another program.

    labels.txt      lines: timestamp class-image [instance-image]
    label/*.png     8 or 16 bit, one class value per pixel
    instance/*.png  8 or 16 bit, one number per object; optional
    classes.json    {"classes": {"wall": 1, "floor": 2, ...}, "roles": {"floor": "ground", ...}}
                    without it, the "classes" of scene_gt.json

What `vsgraphs simulate` writes. Names are handed on as classes, beside the roles. Without "roles", a class
has the role its name speaks for (`role_of_class`).
"""

from __future__ import annotations

from bisect import bisect_left
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

from vsgraphs.datasets.lists import read_list, stamp_of
from vsgraphs.errors import FrameError, InputError
from vsgraphs.reading import open_regular, shown
from vsgraphs.segment.classes import ClassTable, check_name
from vsgraphs.segment.fields import Fields, read_object
from vsgraphs.segment.roles import RoleTable, SurfaceRole, role_named, role_of_class
from vsgraphs.segment.segmentation import Segmentation

# Lists are written with microseconds; frames are never this close.
_SAME_TIME_S = 0.001
_MODES = ("L", "P", "I;16", "I;16B", "I", "1")


class LabelFolder:
    """Segmentations by the colour image's timestamp. Raises InputError for a folder that is none."""

    def __init__(self, folder: Path) -> None:
        self.name = f"labels:{folder}"
        if not folder.is_dir():
            raise InputError(f"label folder {folder} is not a directory")
        listed = folder / "labels.txt"
        if not listed.is_file():
            raise InputError(f"label folder {folder}: labels.txt is missing (lines: timestamp class-image)")
        rows = [(stamp_of(row[0], listed), row[1:3]) for row in read_list(listed, 2)]
        rows.sort(key=lambda row: row[0])
        self._stamps = [stamp for stamp, _ in rows]
        self._files = [[folder / name for name in names] for _, names in rows]
        self._roles, self._classes = _tables(folder)

    def at(self, timestamp_s: float) -> Segmentation | None:
        """The class image of that time, to 1 ms; None if there is none. FrameError: it cannot be read."""
        after = bisect_left(self._stamps, timestamp_s)
        near = [i for i in (after - 1, after) if 0 <= i < len(self._stamps)]
        best = min(near, key=lambda i: abs(self._stamps[i] - timestamp_s), default=None)
        if best is None or abs(self._stamps[best] - timestamp_s) > _SAME_TIME_S:
            return None
        label, *others = self._files[best]
        classes = _load(label)
        instances = _load(others[0]) if others else None
        if instances is not None and instances.shape != classes.shape:
            raise FrameError(f"{others[0]}: shape {instances.shape}, its class image has {classes.shape}")
        try:
            roles = self._roles.roles(classes)
        except InputError as error:
            raise FrameError(f"{label}: {error}") from None
        if not self._classes.names:
            return Segmentation(roles, None, instances)
        return Segmentation(roles, None, instances, self._classes.classes(classes), self._classes.names)


def _tables(folder: Path) -> tuple[RoleTable, ClassTable]:
    for name in ("classes.json", "scene_gt.json"):
        path = folder / name
        if path.is_file():
            break
    else:
        raise InputError(
            f"label folder {folder}: neither classes.json nor scene_gt.json says what its classes are"
        )
    data = read_object(path, "class list")
    if name == "classes.json":
        Fields(data, str(path), ("classes", "roles"))
    classes = data.get("classes")
    if not isinstance(classes, dict) or not classes:
        raise InputError(f'{path}: expected "classes": {{"wall": 1, ...}}')
    for key, value in classes.items():
        if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= 65535:
            raise InputError(f"{path}: class {shown(key)} must have a value from 0 to 65535")
        check_name(key, f"{path}: classes")
    roles = {value: role_of_class(key) for key, value in classes.items()}
    given = data.get("roles", {})
    Fields(given, f"{path}: roles", tuple(classes))
    roles.update({classes[key]: role_named(role, f"{path}: roles") for key, role in given.items()})
    if not any(role not in (SurfaceRole.undecided, SurfaceRole.other) for role in roles.values()):
        raise InputError(f'{path}: no class is wall, ground, ceiling, door or window; say which in "roles"')
    names = {value: key for key, value in classes.items()}
    return RoleTable(roles, str(path), count=0), ClassTable(names, f"{path}: classes")


def _load(path: Path) -> npt.NDArray[np.uint16]:
    if not path.exists():
        raise FrameError(f"{path} is missing")
    try:
        with open_regular(path, "class image") as file, Image.open(file, formats=("PNG",)) as image:
            image.load()
            mode, values = image.mode, np.asarray(image)
    except InputError as error:
        raise FrameError(str(error)) from None
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise FrameError(f"{path} is damaged: {reason}") from None
    if mode not in _MODES:
        raise FrameError(f"{path}: a {mode} image where one number per pixel is expected")
    return _as_uint16(values, path)


def _as_uint16(values: npt.NDArray[Any], path: Path) -> npt.NDArray[np.uint16]:
    if values.size and not 0 <= int(values.min()) <= int(values.max()) <= 65535:
        raise FrameError(f"{path}: values outside 16 bits")
    return np.ascontiguousarray(values, np.uint16)
