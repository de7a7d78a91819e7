"""What can be chosen about a simulation besides its plan."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from vsgraphs.compiled import core
from vsgraphs.errors import InputError
from vsgraphs.plans import LoadedPlan
from vsgraphs.reading import shown

NOISE = ("sensor", "clean")
_MOST = 1_000_000
_MOST_WORKERS = 256
_NOT_OPTIONS = ("none", "validate", "seed")


@dataclass(frozen=True)
class Output:
    """How the sequence is written; none of it changes what the scene looks like."""

    fps: float | None = None  # frames/s rendered, the plan's unless given
    every: int = 1  # keep each n-th frame only (thinning)
    image_format: str = "jpg"  # jpg | png
    jpeg_quality: int = 90
    labels_every: int = 5  # class and instance images with each n-th written frame; 0: none
    overwrite: bool = False  # replace a sequence an earlier call wrote there
    workers: int | None = None  # threads; the processors' number, at most 4, unless given

    def check(self) -> None:
        """Raises InputError naming the first option out of range."""
        for key in ("every", "labels_every"):
            value, least = getattr(self, key), 0 if key == "labels_every" else 1
            if not least <= value <= _MOST:
                raise InputError(f"{key} must be at least {least} and at most {_MOST}, not {shown(value)}")
        if self.image_format not in ("jpg", "png"):
            raise InputError(f"image_format must be jpg or png, not {shown(self.image_format)}")
        if not 1 <= self.jpeg_quality <= 100:
            raise InputError(f"jpeg_quality must lie in 1..100, not {self.jpeg_quality}")
        if self.workers is not None and not 1 <= self.workers <= _MOST_WORKERS:
            raise InputError(
                f"workers must be at least 1 and at most {_MOST_WORKERS}, not {shown(self.workers)}"
            )


def noise_options(noise: str | Mapping[str, float | bool], seed: int) -> Any:
    """The core's NoiseOptions for "sensor", "clean" or changes to "sensor"; InputError names the fault."""
    kinds = core().NoiseOptions
    if isinstance(noise, str):
        if noise not in NOISE:
            raise InputError(f"noise must be one of {', '.join(NOISE)}, not {shown(noise)}")
        options = kinds() if noise == "sensor" else kinds.none()
    else:
        options = kinds()
        known = [
            name
            for name in dir(options)
            if not name.startswith("_") and name not in ("none", "validate", "seed")
        ]
        for key, value in noise.items():
            if key not in known:
                raise InputError(f"unknown noise option '{key}'; known: {', '.join(known)}")
            try:
                setattr(options, key, value)
            except TypeError:
                raise InputError(f"noise.{key} cannot be {shown(value)}") from None
    if not 0 <= seed < 2**63:
        raise InputError(f"seed must lie in 0..2^63-1, not {seed}")
    options.seed = seed
    try:
        options.validate()
    except ValueError as error:
        raise InputError(str(error)) from None
    return options


def camera_of(loaded: LoadedPlan) -> Any:
    """The core's Camera for a plan; a Kinect-like 640x480 where it names none."""
    fields: dict[str, Any] = loaded.camera or {
        "width": 640, "height": 480, "fx": 525.0, "fy": 525.0, "cx": 319.5, "cy": 239.5,
    }  # fmt: skip
    try:
        return core().Camera(**fields, depth_min_m=0.35, depth_max_m=6.0)
    except ValueError as error:
        raise InputError(f"{loaded.source}: {error}") from None
