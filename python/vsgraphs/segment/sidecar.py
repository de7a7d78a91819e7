"""The file beside an ONNX model that says what goes in and what comes out (docs/segmentation.md)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from vsgraphs.errors import InputError
from vsgraphs.reading import shortened, shown
from vsgraphs.segment.classes import ClassTable, check_names
from vsgraphs.segment.fields import Fields, read_object
from vsgraphs.segment.roles import RoleTable, SurfaceRole, role_named

# Of a network's image, pixels.
LARGEST_SIDE = 8192
_SMALLEST = 1e-6  # what an image is divided by
# The tensors each kind of output consists of: those it must have, those it may have.
KINDS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "semantic": (("scores",), ()),
    "semantic_argmax": (("classes",), ()),
    "panoptic_masks": (("class_logits", "mask_logits"), ()),
    "panoptic_segments": (("segments", "segment_classes"), ("segment_scores", "segment_ids")),
}
_OPTIONS = {
    "semantic": ("layout", "values"),
    "semantic_argmax": (),
    "panoptic_masks": ("score_threshold", "overlap_threshold", "void_class"),
    "panoptic_segments": ("void_segment",),
}


@dataclass(frozen=True)
class InputFormat:
    """How an image becomes the network's input: stretched to `size`, then (value * scale - mean) / std."""

    name: str | None
    size: tuple[int, int] | None  # width, height, pixels; None: what the model says
    layout: str  # NCHW or NHWC
    colour: str  # rgb or bgr
    scale: float
    mean: tuple[float, ...]  # in the order of `colour`
    std: tuple[float, ...]


@dataclass(frozen=True)
class OutputFormat:
    """What the network's outputs mean."""

    kind: str  # of KINDS
    tensors: dict[str, str]  # part -> the output's name
    layout: str = "NCHW"  # of semantic scores
    values: str = "logits"  # or probabilities
    score_threshold: float = 0.8
    overlap_threshold: float = 0.8
    void_class: int | None = None  # None: the last
    void_segment: int = 0


@dataclass(frozen=True)
class Sidecar:
    """A sidecar file."""

    path: Path
    input: InputFormat
    output: OutputFormat
    roles: RoleTable
    classes: ClassTable | None  # None: the sidecar does not name them

    def named(
        self, values: npt.NDArray[Any]
    ) -> tuple[npt.NDArray[np.uint16], tuple[str, ...]] | tuple[None, None]:
        """Numbers of classes and their names, as a Segmentation has them; `roles` knows all the values."""
        if self.classes is None or not self.classes.names:
            return None, None
        return self.classes.classes(values), self.classes.names


def read_sidecar(path: Path) -> Sidecar:
    """Reads a sidecar. Raises InputError that names the file and the key."""
    root = Fields(
        read_object(path, "sidecar"), str(path), ("input", "output", "classes", "roles", "model_card")
    )
    names = _class_names(root)
    return Sidecar(
        path,
        _input(root.required("input"), f"{path}: input"),
        _output(root.required("output"), f"{path}: output"),
        _roles(root, names),
        None if names is None else ClassTable(dict(enumerate(names)), f"{path}: classes"),
    )


def _input(data: Any, where: str) -> InputFormat:
    fields = Fields(data, where, ("name", "size", "layout", "colour", "scale", "mean", "std"))
    size = None
    if fields.has("size"):
        width, height = fields.numbers("size", 2, ())
        if not 1 <= min(width, height) <= max(width, height) <= LARGEST_SIDE or width % 1 or height % 1:
            raise fields.wrong("size", f"[width, height] in whole pixels, 1 to {LARGEST_SIDE}")
        size = (int(width), int(height))
    scale = fields.number("scale", 1.0)
    mean, std = fields.numbers("mean", 3, (0, 0, 0)), fields.numbers("std", 3, (1, 1, 1))
    if min(map(abs, std)) < _SMALLEST:
        raise fields.wrong("std", f"different from 0, at least {_SMALLEST:g}")
    for key, values in (("scale", (scale,)), ("mean", mean), ("std", std)):
        if max(map(abs, values)) > 1 / _SMALLEST:
            raise fields.wrong(key, f"at most {1 / _SMALLEST:g}")
    return InputFormat(
        name=fields.text("name") if fields.has("name") else None,
        size=size,
        layout=fields.choice("layout", ("NCHW", "NHWC")),
        colour=fields.choice("colour", ("rgb", "bgr"), "rgb"),
        scale=scale,
        mean=mean,
        std=std,
    )


def _output(data: Any, where: str) -> OutputFormat:
    kinds = tuple(KINDS)
    every = [part for must, may in KINDS.values() for part in (*must, *may)]
    options = [option for some in _OPTIONS.values() for option in some]
    kind = Fields(data, where, ("kind", *every, *options)).choice("kind", kinds)
    must, may = KINDS[kind]
    fields = Fields(data, f"{where} ({kind})", ("kind", *must, *may, *_OPTIONS[kind]))
    return OutputFormat(
        kind=kind,
        tensors={part: fields.text(part) for part in (*must, *may) if part in must or fields.has(part)},
        layout=fields.choice("layout", ("NCHW", "NHWC"), "NCHW"),
        values=fields.choice("values", ("logits", "probabilities"), "logits"),
        score_threshold=fields.share("score_threshold", 0.8),
        overlap_threshold=fields.share("overlap_threshold", 0.8),
        void_class=fields.integer("void_class", 0) if fields.has("void_class") else None,
        void_segment=fields.integer("void_segment", 0, 65535),
    )


def _class_names(root: Fields) -> list[str] | None:
    if not root.has("classes"):
        return None
    classes = root.required("classes")
    if not isinstance(classes, list) or not all(isinstance(name, str) for name in classes) or not classes:
        raise InputError(f"{root.where}: 'classes' must be a list of names, class 0 first")
    if len(set(classes)) < len(classes):
        twice = next(name for name in classes if classes.count(name) > 1)
        raise InputError(f"{root.where}: 'classes' lists {shown(twice)} twice")
    check_names(classes, f"{root.where}: classes")
    return classes


def _roles(root: Fields, classes: list[str] | None) -> RoleTable:
    """Roles by class name where `classes` lists them, or by number."""
    where = f"{root.where}: roles"
    names = classes or []
    given = root.required("roles")
    numbered = {key: None for key in given if key.isdecimal()} if isinstance(given, dict) else {}
    Fields(given, where, (*names, *numbered))
    roles: dict[int, SurfaceRole] = {}
    for key, role in given.items():
        if key == "comment":
            continue
        roles[names.index(key) if key in names else _class_number(key, where)] = role_named(role, where)
    if not roles:
        raise InputError(f'{where}: no class has a role; e.g. {{"wall": "wall", "floor": "ground"}}')
    return RoleTable(roles, str(root.where), None if classes is None else len(classes))


def _class_number(key: str, where: str) -> int:
    if len(key) > 5 or int(key) > 65535:
        raise InputError(f"{where}: class {shortened(key)} is beyond 65535")
    return int(key)
