"""What a segmenter is and what it hands over."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from vsgraphs.errors import InputError
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
    """

    roles: npt.NDArray[np.uint8]
    confidence: npt.NDArray[np.float32] | None = None
    instances: npt.NDArray[np.uint16] | None = None


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
    return Segmentation(roles, confidence, instances)


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
