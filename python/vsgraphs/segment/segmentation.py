"""What a segmenter is and what it hands over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from vsgraphs.errors import InputError
from vsgraphs.segment.classes import check_names
from vsgraphs.segment.roles import SurfaceRole

Rgb = npt.NDArray[np.uint8]


@dataclass(frozen=True)
class Segmentation:
    """What each part of an image is.

    The arrays cover the whole image, may be coarser or finer than it, and all have one shape (h, w); a pixel
    takes the value of the nearest element after scaling to the image's size.

    roles: uint8, values of `SurfaceRole`.
    confidence: float32, 0 to 1, the weight of each vote; None: 1 everywhere.
    instances: uint16, 0 where there is none, else one number per object; None: the segmenter knows none.
    classes: uint16, the segmenter's own classes: 0 where there is none, else k for the k-th of `class_names`;
        None: it knows none. They say nothing of roles.
    class_names: one name per class, each of 1 to 128 bytes (UTF-8) and there once.
    """

    roles: npt.NDArray[np.uint8]
    confidence: npt.NDArray[np.float32] | None = None
    instances: npt.NDArray[np.uint16] | None = None
    classes: npt.NDArray[np.uint16] | None = None
    class_names: Sequence[str] | None = None


class Segmenter(Protocol):
    """Anything that can be called with an image. Called from one thread at a time."""

    def __call__(self, rgb: Rgb, /) -> Segmentation:
        """Segments (H, W, 3) uint8 RGB."""
        ...


@runtime_checkable
class RecordedSegmentations(Protocol):
    """Segmentations that were made before, found by time."""

    def at(self, timestamp_s: float) -> Segmentation | None:
        """That of the colour image taken then; None if there is none. FrameError: it cannot be read."""
        ...


def name_of(segmenter: Segmenter | RecordedSegmentations) -> str:
    """What messages and run.json call a segmenter: its `name`, a function's name, or its class's."""
    given = getattr(segmenter, "name", None) or getattr(segmenter, "__name__", None)
    return str(given or type(segmenter).__name__)


def checked(result: Any, name: str) -> Segmentation:
    """`result` with contiguous arrays. Raises InputError that names the segmenter and what is wrong."""
    if not isinstance(result, Segmentation):
        raise InputError(f"segmenter {name}: expected a Segmentation, got {type(result).__name__}")
    roles = _array(result.roles, np.uint8, "roles", name)
    if roles.ndim != 2 or roles.size == 0:
        raise InputError(f"segmenter {name}: roles must have shape (h, w), not {roles.shape}")
    if roles.max() > max(SurfaceRole):
        raise InputError(
            f"segmenter {name}: roles holds {roles.max()}, the largest SurfaceRole is {int(max(SurfaceRole))}"
        )
    confidence, instances = result.confidence, result.instances
    if confidence is not None:
        confidence = _array(confidence, np.float32, "confidence", name, roles.shape)
        if not (confidence.min() >= 0 and confidence.max() <= 1):  # also false for NaN
            raise InputError(
                f"segmenter {name}: confidence must be 0 to 1, it is {confidence.min()} to {confidence.max()}"
            )
    if instances is not None:
        instances = _array(instances, np.uint16, "instances", name, roles.shape)
    classes, names = _checked_classes(result, name, roles.shape)
    return Segmentation(roles, confidence, instances, classes, names)


def _checked_classes(
    result: Segmentation, name: str, shape: tuple[int, ...]
) -> tuple[npt.NDArray[np.uint16] | None, tuple[str, ...] | None]:
    if (result.classes is None) != (result.class_names is None):
        raise InputError(f"segmenter {name}: classes and class_names go together, class k is the k-th name")
    if result.classes is None:
        return None, None
    classes = _array(result.classes, np.uint16, "classes", name, shape)
    names = check_names(result.class_names, f"segmenter {name}: class_names")
    if not names:
        raise InputError(f"segmenter {name}: class_names is empty; leave it and classes out")
    if classes.max() > len(names):
        raise InputError(
            f"segmenter {name}: classes holds {classes.max()}, beyond the {len(names)} of class_names"
        )
    return classes, names


def _array(
    array: Any, dtype: type[np.generic], what: str, name: str, shape: tuple[int, ...] | None = None
) -> npt.NDArray[Any]:
    if not isinstance(array, np.ndarray):
        raise InputError(f"segmenter {name}: {what} must be a numpy array, not {type(array).__name__}")
    if array.dtype != dtype:
        raise InputError(f"segmenter {name}: {what} must be {np.dtype(dtype)}, not {array.dtype}")
    if shape is not None and array.shape != shape:
        raise InputError(f"segmenter {name}: {what} has shape {array.shape}, roles {shape}")
    return np.ascontiguousarray(array)
