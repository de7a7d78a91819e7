"""What every dataset becomes: a list of frames with timestamps, loaded one by one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from vsgraphs.datasets.calibration import Calibration

if TYPE_CHECKING:
    from vsgraphs.datasets.straighten import StraightGrid
    from vsgraphs.trajectory import Trajectory

Rgb = npt.NDArray[np.uint8]
Depth = npt.NDArray[np.uint16]


@dataclass(frozen=True)
class ColourGrid:
    """Where a colour image with a camera of its own is sampled, so that it fits the depth image.

    size: of the colour file, pixels. Pixel (u, v) of the depth image looks at the colour image's
    (scale[0] u + offset[0], scale[1] v + offset[1]); pixel centres at integers.
    """

    size: tuple[int, int]
    scale: tuple[float, float]
    offset: tuple[float, float]


@dataclass(frozen=True)
class FrameRef:
    """One frame on disk: its time in seconds and where its images are.

    colour_grid: how colour gets the depth image's pixels; None where it has them already.
    straight: how the images become a pinhole's; None where the camera needs no help.
    """

    timestamp: float
    rgb_path: Path
    depth_path: Path
    size: tuple[int, int]  # width, height the camera promises, pixels
    colour_grid: ColourGrid | None = None
    straight: StraightGrid | None = None

    @property
    def files(self) -> tuple[Path, ...]:
        """All that `load` reads."""
        return self.rgb_path, self.depth_path

    def load(self) -> tuple[Rgb, Depth]:
        """Decodes rgb (H, W, 3) uint8 and depth (H, W) uint16 raw units; FrameError if either is unusable."""
        from vsgraphs.datasets.decode import load_depth, load_rgb, load_rgb_on_grid

        grid = self.colour_grid
        if grid is None:
            rgb = load_rgb(self.rgb_path, self.size)
        else:
            rgb = load_rgb_on_grid(self.rgb_path, grid.size, self.size, grid.scale, grid.offset)
        depth = load_depth(self.depth_path, self.size)
        if self.straight is None:
            return rgb, depth
        return self.straight.colour(rgb), self.straight.depth(depth)


class Sequence(Protocol):
    """A recorded RGB-D sequence; `camera` is what `vsgraphs.Slam` takes."""

    @property
    def name(self) -> str:
        """The folder's name."""
        ...

    @property
    def format(self) -> str:
        """The format's name."""
        ...

    @property
    def path(self) -> Path:
        """The folder."""
        ...

    @property
    def camera(self) -> Any:
        """A new `vsgraphs.Camera`."""
        ...

    @property
    def calibration(self) -> Calibration:
        """The camera's numbers, without the compiled module."""
        ...

    @property
    def frames(self) -> list[FrameRef]:
        """In order of time."""
        ...

    @property
    def groundtruth(self) -> Trajectory | None:
        """The true trajectory, if the dataset has one."""
        ...

    @property
    def skipped(self) -> dict[str, int]:
        """Reason -> count of listed frames that can never be used."""
        ...

    @property
    def warnings(self) -> list[str]:
        """What was repaired while opening."""
        ...


@dataclass
class RecordedSequence:
    """A sequence whose frames are pairs of image files: what all readers here return."""

    path: Path
    format: str
    calibration: Calibration
    frames: list[FrameRef]
    groundtruth_reader: Callable[[], Trajectory] | None = None
    skipped: dict[str, int] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    _groundtruth: Trajectory | None = field(default=None, repr=False)

    @property
    def name(self) -> str:
        """The folder's name."""
        return self.path.resolve().name

    @property
    def length(self) -> int:
        """How many frames there are."""
        return len(self.frames)

    @property
    def info(self) -> dict[str, str]:
        """What run.json says of it."""
        return {
            "name": self.name,
            "path": str(self.path.resolve()),
            "format": self.format,
            "camera": self.calibration.origin,
        }

    @property
    def camera(self) -> Any:
        """A new `vsgraphs.Camera` from the calibration."""
        return self.calibration.to_core()

    @property
    def groundtruth(self) -> Trajectory | None:
        """The true trajectory, read at first use; None when there is none."""
        if self._groundtruth is None and self.groundtruth_reader is not None:
            self._groundtruth = self.groundtruth_reader()
        return self._groundtruth

    def describe(self) -> str:
        """One line for people: what was detected."""
        span = self.frames[-1].timestamp - self.frames[0].timestamp if self.frames else 0.0
        truth = "with ground truth" if self.groundtruth_reader else "no ground truth"
        return (
            f"{self.format} sequence {self.name}: {len(self.frames)} frames, {span:.1f} s, {truth}; "
            f"camera {self.calibration.width}x{self.calibration.height} from {self.calibration.origin}"
        )
