"""Recorded RGB-D sequences: one file per format, all giving the same `Sequence`."""

from vsgraphs.datasets.calibration import Calibration
from vsgraphs.datasets.camera_file import read_camera_file
from vsgraphs.datasets.cameras import CAMERAS, named_camera
from vsgraphs.datasets.open import FORMATS, open_sequence
from vsgraphs.datasets.sequence import FrameRef, RecordedSequence, Sequence

__all__ = [
    "CAMERAS",
    "FORMATS",
    "Calibration",
    "FrameRef",
    "RecordedSequence",
    "Sequence",
    "named_camera",
    "open_sequence",
    "read_camera_file",
]
