"""What can be chosen about a simulation besides its plan."""

from __future__ import annotations

from dataclasses import dataclass

from vsgraphs.errors import InputError
from vsgraphs.reading import shown

_MOST = 1_000_000
_MOST_WORKERS = 256


@dataclass(frozen=True)
class Output:
    """How the sequence is written; none of it changes what the scene looks like."""

    fps: float | None = None  # frames/s rendered, the plan's unless given
    every: int = 1  # keep each n-th frame only (thinning)
    image_format: str = "jpg"  # jpg | png
    jpeg_quality: int = 90
    labels_every: int = 5  # class and instance images with each n-th written frame; 0: none
    overwrite: bool = False  # replace a sequence an earlier call wrote there
    motion: bool = False  # imu.txt and odometry.txt beside the frames
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
