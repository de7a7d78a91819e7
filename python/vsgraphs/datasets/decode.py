"""Image files -> arrays, fast and mostly without the interpreter lock: tracking runs beside it.

Pillow decodes JPEG in 0.8 ms (640x480), then spends two more on packing its 4-byte pixels into a numpy array.
Where Pillow lends its pixels (Arrow interface, since 11.2) they are packed here by three strided copies
instead.
"""

from __future__ import annotations

import ctypes
import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import (
    Image,
    JpegImagePlugin,  # noqa: F401  (registers itself, so that Pillow need not load all its formats)
    PngImagePlugin,  # noqa: F401
)

from vsgraphs.errors import FrameError, InputError
from vsgraphs.reading import open_regular

_FORMATS = ("JPEG", "PNG")
_DEPTH_MODES = ("I;16", "I;16L", "I;16B", "I")


def load_rgb(path: Path, size: tuple[int, int]) -> npt.NDArray[np.uint8]:
    """Colour image -> (H, W, 3) uint8 RGB. Raises FrameError: missing, damaged, or not of `size` (w, h)."""
    image = _open(path, size)
    if image.mode not in ("RGB", "RGBA", "RGBX"):
        if image.mode not in ("L", "P", "1", "CMYK", "YCbCr", "LA", "PA"):
            raise FrameError(f"{path}: a {image.mode} image where colour is expected")
        image = image.convert("RGB")
    lent = _lend_pixels(image)
    if lent is None:
        return np.ascontiguousarray(np.asarray(image)[:, :, :3])
    rgb = np.empty((size[1], size[0], 3), np.uint8)
    for channel in range(3):
        rgb[:, :, channel] = lent[:, :, channel]
    return rgb


def load_rgb_on_grid(
    path: Path,
    file_size: tuple[int, int],
    size: tuple[int, int],
    scale: tuple[float, float],
    offset: tuple[float, float],
) -> npt.NDArray[np.uint8]:
    """Colour image of `file_size` (w, h) -> (H, W, 3) uint8 RGB of `size`, as `ColourGrid` says.

    Each pixel is smoothed over its footprint; pixels that look past the rim repeat the last one that does
    not. Raises FrameError as `load_rgb` does, also when nothing of the colour image is looked at.
    """
    image = _open(path, file_size)
    if image.mode != "RGB":
        image = image.convert("RGB")
    spans = [_inside(size[k], file_size[k], scale[k], offset[k]) for k in (0, 1)]
    (x0, x1), (y0, y1) = spans
    if x0 >= x1 or y0 >= y1:
        raise FrameError(f"{path}: the depth camera sees nothing of this image; wrong intrinsics?")
    left, right = (scale[0] * (x - 0.5) + offset[0] + 0.5 for x in (x0, x1))
    top, bottom = (scale[1] * (y - 0.5) + offset[1] + 0.5 for y in (y0, y1))
    box = (max(left, 0.0), max(top, 0.0), min(right, file_size[0]), min(bottom, file_size[1]))
    part = np.asarray(image.resize((x1 - x0, y1 - y0), Image.Resampling.BILINEAR, box=box))
    rim = ((y0, size[1] - y1), (x0, size[0] - x1), (0, 0))
    return np.ascontiguousarray(np.pad(part, rim, mode="edge"))


def _inside(pixels: int, file_pixels: int, scale: float, offset: float) -> tuple[int, int]:
    """First and one past the last pixel along an axis whose footprint lies in the file's image."""
    slack = 1e-6  # of a pixel: footprints that end at the rim
    first = math.ceil((-0.5 - offset) / scale + 0.5 - slack)
    last = math.floor((file_pixels - 0.5 - offset) / scale + 0.5 + slack)
    return max(first, 0), min(last, pixels)


def image_size(path: Path) -> tuple[int, int]:
    """(width, height) from an image's header. Raises FrameError: missing or not an image."""
    if not path.exists():
        raise FrameError(f"{path} is missing")
    try:
        with open_regular(path, "image") as file, Image.open(file, formats=_FORMATS) as image:
            return image.size
    except InputError as error:
        raise FrameError(str(error)) from None
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        raise FrameError(f"{path} is damaged: {_short(error)}") from None


def load_depth(path: Path, size: tuple[int, int]) -> npt.NDArray[np.uint16]:
    """16-bit depth image -> (H, W) uint16 raw units. Raises FrameError as `load_rgb` does."""
    image = _open(path, size)
    if image.mode not in _DEPTH_MODES:
        raise FrameError(f"{path}: a {image.mode} image where 16-bit depth is expected")
    depth = np.asarray(image)
    if depth.dtype != np.uint16:
        if depth.min() < 0 or depth.max() > 65535:
            raise FrameError(f"{path}: depth values outside 16 bits")
        depth = depth.astype(np.uint16)
    return np.ascontiguousarray(depth)


def _open(path: Path, size: tuple[int, int]) -> Image.Image:
    if not path.exists():
        raise FrameError(f"{path} is missing")
    try:
        with open_regular(path, "image") as file, Image.open(file, formats=_FORMATS) as image:
            given = image.size  # known from the header: an image of a wrong size is never decoded
            if given == size:
                image.load()
    except InputError as error:
        raise FrameError(str(error)) from None
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        raise FrameError(f"{path} is damaged: {_short(error)}") from None
    if given != size:
        raise FrameError(f"{path}: {given[0]}x{given[1]} pixels, the camera has {size[0]}x{size[1]}")
    return image


def _short(error: Exception) -> str:
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    if type(error).__name__ == "UnidentifiedImageError":
        return "not a JPEG or PNG image"
    return str(error).splitlines()[0] if str(error) else type(error).__name__


class _ArrowArray(ctypes.Structure):
    """The C data interface Arrow publishes (arrow.apache.org/docs/format/CDataInterface.html)."""


_ArrowArray._fields_ = [
    ("length", ctypes.c_int64),
    ("null_count", ctypes.c_int64),
    ("offset", ctypes.c_int64),
    ("n_buffers", ctypes.c_int64),
    ("n_children", ctypes.c_int64),
    ("buffers", ctypes.POINTER(ctypes.c_void_p)),
    ("children", ctypes.POINTER(ctypes.POINTER(_ArrowArray))),
    ("dictionary", ctypes.c_void_p),
    ("release", ctypes.c_void_p),
    ("private_data", ctypes.c_void_p),
]

_capsule_pointer = ctypes.pythonapi.PyCapsule_GetPointer
_capsule_pointer.restype = ctypes.c_void_p
_capsule_pointer.argtypes = [ctypes.py_object, ctypes.c_char_p]


def _lend_pixels(image: Image.Image) -> npt.NDArray[np.uint8] | None:
    """(H, W, 4) view of the image's own memory, or None where this Pillow or this image cannot lend it."""
    export = getattr(image, "__arrow_c_array__", None)
    if export is None:
        return None
    try:
        capsule: Any = export()[1]
    except ValueError:  # a large image in several blocks of memory
        return None
    pixels = _ArrowArray.from_address(_capsule_pointer(capsule, b"arrow_array"))
    width, height = image.size
    if pixels.n_children != 1 or pixels.offset != 0 or pixels.length != width * height:
        return None
    channel = pixels.children[0].contents
    if channel.n_buffers != 2 or channel.length != 4 * width * height:
        return None
    memory: Any = (ctypes.c_uint8 * (4 * width * height)).from_address(channel.buffers[1])
    memory.owner = capsule  # the view keeps the pixels alive
    view: npt.NDArray[np.uint8] = np.frombuffer(memory, np.uint8).reshape(height, width, 4)
    return view
