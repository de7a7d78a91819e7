"""vsgraphs: RGB-D SLAM and 3D scene graphs in one factor graph.

    result = vsgraphs.run("path/to/sequence", out="results")  # all that the program `vsgraphs run` does

Or frame by frame:

    config = vsgraphs.Config()
    slam = vsgraphs.Slam(config, sequence.camera)
    for rgb, depth, timestamp in frames:  # (H, W, 3) uint8, (H, W) uint16 raw or float32 m, seconds
        result = slam.track(rgb, depth, timestamp)
    slam.finish()
    timestamps, poses = slam.trajectory()  # (N,) seconds, (N, 4, 4) world_from_camera, metres

Importing the package loads nothing; each name loads what it needs at first use.
"""

from __future__ import annotations

# Not typing's, which takes longer to import than all else that the program does before it heeds Ctrl-C.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from typing import Any

    from vsgraphs._core import Atlas as Atlas
    from vsgraphs._core import AtlasState as AtlasState
    from vsgraphs._core import Camera as Camera
    from vsgraphs._core import Config as Config
    from vsgraphs._core import Slam as Slam
    from vsgraphs._core import Snapshot as Snapshot
    from vsgraphs._core import TrackResult as TrackResult
    from vsgraphs._core import load_atlas as load_atlas
    from vsgraphs.datasets import Calibration as Calibration
    from vsgraphs.datasets import Sequence as Sequence
    from vsgraphs.datasets import open_sequence as open_sequence
    from vsgraphs.errors import FrameError as FrameError
    from vsgraphs.errors import InputError as InputError
    from vsgraphs.evaluate import evaluate as evaluate
    from vsgraphs.run import Result as Result
    from vsgraphs.run import run as run
    from vsgraphs.trajectory import Trajectory as Trajectory

_CORE = ("Atlas", "AtlasState", "Camera", "Config", "Slam", "Snapshot", "TrackResult", "load_atlas")
_PYTHON = {
    "Calibration": "vsgraphs.datasets",
    "FrameError": "vsgraphs.errors",
    "InputError": "vsgraphs.errors",
    "Result": "vsgraphs.run",
    "Sequence": "vsgraphs.datasets",
    "Trajectory": "vsgraphs.trajectory",
    "evaluate": "vsgraphs.evaluate",
    "open_sequence": "vsgraphs.datasets",
}

__all__ = [
    "Atlas",
    "AtlasState",
    "Calibration",
    "Camera",
    "Config",
    "FrameError",
    "InputError",
    "Result",
    "Sequence",
    "Slam",
    "Snapshot",
    "TrackResult",
    "Trajectory",
    "evaluate",
    "load_atlas",
    "open_sequence",
    "run",
]


def __getattr__(name: str) -> Any:
    value: Any
    if name in _CORE:
        from vsgraphs.compiled import core

        value = getattr(core(), name)
    elif name in _PYTHON:
        import importlib

        value = getattr(importlib.import_module(_PYTHON[name]), name)
    elif name == "run":
        import importlib

        value = importlib.import_module("vsgraphs.run")  # a module that can be called
    elif name == "__version__":
        from vsgraphs.version import version

        value = version()
    else:
        raise AttributeError(f"module 'vsgraphs' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__, "__version__"])
