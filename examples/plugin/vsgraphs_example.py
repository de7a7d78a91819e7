"""A package that adds a source, a segmenter, an exporter and a check: `pip install examples/plugin`."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

import vsgraphs
from vsgraphs.segment import Segmentation, Segmenter, SurfaceRole
from vsgraphs.sources import Depth, Rgb

_STILL_M = 0.5


@dataclass(frozen=True)
class NpzFrame:
    """A file that holds `rgb` and `depth`; its name is its time in seconds."""

    path: Path

    @property
    def timestamp(self) -> float:
        """Seconds."""
        return float(self.path.stem)

    def load(self) -> tuple[Rgb, Depth]:
        """Reads the images; a damaged file costs its frame alone."""
        try:
            with np.load(self.path) as arrays:
                return arrays["rgb"], arrays["depth"]
        except Exception as error:
            raise vsgraphs.FrameError(f"{self.path} cannot be read: {error}") from None


class NpzFolder:
    """A folder of 12.500000.npz, ... and camera.json, the fields of vsgraphs.Calibration."""

    def __init__(self, folder: Path) -> None:
        if not (folder / "camera.json").is_file():
            raise vsgraphs.InputError(f"{folder} holds no camera.json")
        self.camera = vsgraphs.Calibration(**json.loads((folder / "camera.json").read_text()))
        self.frames = sorted(map(NpzFrame, folder.glob("*.npz")), key=lambda frame: frame.timestamp)
        self.info = {"name": folder.name, "path": str(folder.resolve()), "format": "npz"}


def open_npz(text: str) -> NpzFolder:
    """The source npz:FOLDER."""
    return NpzFolder(Path(text))


def make_level(text: str) -> Segmenter:
    """The segmenter level:SHARE, for a camera held level: wall above that share of the image, then ground."""
    share = float(text or 0.75)

    def level(rgb: npt.NDArray[np.uint8]) -> Segmentation:
        roles = np.full((rgb.shape[0], 1), SurfaceRole.wall, np.uint8)
        roles[round(share * len(roles)) :] = SurfaceRole.ground
        return Segmentation(roles)

    return level


def rooms_csv(result: vsgraphs.Result) -> dict[str, str]:
    """The exporter rooms-csv: a table of rooms."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["id", "name", "area_m2"])
    for room in result.scene_graph.rooms.values() if result.scene_graph else ():
        table.writerow([room.id, room.name, f"{room.area_m2:.2f}"])
    return {"rooms.csv": text.getvalue()}


def still_camera(result: vsgraphs.Result) -> Iterator[str]:
    """The check still-camera."""
    way_m = np.linalg.norm(np.diff(result.trajectory.positions, axis=0), axis=1).sum()
    if way_m < _STILL_M:
        yield f"the camera moved {way_m:.2f} m only: a map wants some metres"
