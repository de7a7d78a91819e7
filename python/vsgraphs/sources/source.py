"""What a source of frames is. Two members are needed, the others have defaults."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

Rgb = npt.NDArray[np.uint8]
Depth = npt.NDArray[np.uint16] | npt.NDArray[np.float32]


class Frame(Protocol):
    """A colour and a depth image of one moment, loaded when they are needed."""

    @property
    def timestamp(self) -> float:
        """Seconds; later than the frame before."""
        ...

    def load(self) -> tuple[Rgb, Depth]:
        """(H, W, 3) uint8 RGB; (H, W) uint16 in units of the camera's depth_scale, or float32 metres.

        On a thread of its own, but for live sources. Raises FrameError for a frame that cannot be read: it is
        skipped and counted.
        """
        ...


@dataclass(frozen=True, eq=False)
class ImageFrame:
    """A frame whose images are in memory, as a camera's. They must not change any more."""

    timestamp: float
    rgb: Rgb
    depth: Depth

    def load(self) -> tuple[Rgb, Depth]:
        """The images."""
        return self.rgb, self.depth


class Source(Protocol):
    """A camera and its frames. A recorded sequence is one (`vsgraphs.open_sequence`).

    These are optional attributes (`facts_of` reads them all):
    live: True for a camera. Frames are then taken as they come; those that come while an earlier one is
      tracked are dropped. The run ends when the frames do, or when it is told to.
    length: how many frames there are; without it len(frames), or nobody knows.
    info: {"name": ..., ...}, what run.json says of the source; values as in JSON.
    streams: what comes beside the frames, by name. "segmentations": an object with `at(timestamp_s)`, see
      vsgraphs.segment.RecordedSegmentations, for `--segmenter source`.
    warnings: lines to be told. skipped: {reason: frames that can never be used}.
    """

    @property
    def camera(self) -> Any:
        """A `vsgraphs.Camera`, or a `vsgraphs.Calibration`."""
        ...

    @property
    def frames(self) -> Iterable[Frame]:
        """In order of time; may be a generator, may block, may end.

        Asked for once in a run, and iterated by one thread at a time, which is not the caller's.
        """
        ...
