"""Which dataset is in this folder? Adding a format is adding a file like tum.py and a line to `FORMATS`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Protocol

from vsgraphs.datasets import icl_nuim, openloris, redwood, replica, scannet, seven_scenes, tum
from vsgraphs.datasets.calibration import Calibration
from vsgraphs.datasets.sequence import RecordedSequence
from vsgraphs.datasets.straighten import StraightGrid
from vsgraphs.errors import InputError


class Format(Protocol):
    """What a format's module offers."""

    NAME: str
    LOOKED_FOR: str

    def detect(self, folder: Path) -> bool:
        """Whether the folder looks like this format."""
        ...

    def open_folder(self, folder: Path, camera: str | Path | Calibration | None = None) -> RecordedSequence:
        """Opens the sequence; raises InputError when nothing in it can be used."""
        ...


# In order of detection: an ICL-NUIM folder also looks like a TUM one.
FORMATS: tuple[Format, ...] = (openloris, icl_nuim, seven_scenes, replica, tum, scannet, redwood)


def open_sequence(path: str | Path, camera: str | Path | Calibration | None = None) -> RecordedSequence:
    """Opens a recorded sequence of any known format.

    camera: a camera.yaml, the name of a known camera, or None for what the folder holds. Reads lists, not
    images. Raises InputError when there is nothing to open, saying what was looked for.
    """
    folder = Path(path)
    if not folder.exists():
        raise InputError(f"{folder} does not exist")
    if not folder.is_dir():
        raise InputError(f"{folder} is a file; expected the folder of a sequence")
    try:
        names = sorted(entry.name for entry in folder.iterdir())
        for reader in FORMATS:
            if reader.detect(folder):
                return _straightened(reader.open_folder(folder, camera))
    except PermissionError as error:
        raise InputError(f"{error.filename or folder} may not be read: {error.strerror}") from None
    raise InputError(_nothing_found(folder, names))


def _straightened(sequence: RecordedSequence) -> RecordedSequence:
    """The sequence as a pinhole with the lens's focal lengths and centre sees it; unchanged without a lens.

    Colour is blended between pixels, depth is the nearest pixel's. Raises InputError where colour has a
    camera of its own.
    """
    lens = sequence.calibration.lens
    if lens is None:
        return sequence
    if any(frame.colour_grid is not None for frame in sequence.frames):
        raise InputError(
            f"{sequence.calibration.origin}: a {lens.model} lens cannot be undone where colour and "
            "depth have cameras of their own; give images without distortion"
        )
    grid = StraightGrid(sequence.calibration, lens)
    sequence.frames = [replace(frame, straight=grid) for frame in sequence.frames]
    sequence.warnings.append(
        f"{sequence.calibration.origin}: {lens.model} lens undone at reading, images are those of a pinhole"
    )
    return sequence


def _nothing_found(folder: Path, names: list[str]) -> str:
    looked = "; ".join(f"{reader.NAME}: {reader.LOOKED_FOR}" for reader in FORMATS)
    if not names:
        return f"{folder} is empty; looked for {looked}"
    for entry in sorted(folder.iterdir()):
        if entry.is_dir() and any(reader.detect(entry) for reader in FORMATS):
            return f"{folder} holds no sequence itself, but {entry} does: give that one"
    return f"{folder} holds no sequence in a known format; looked for {looked}"
