"""A camera's numbers, without the compiled module."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.reading import shown

_LARGEST_PX = 8192
_BESIDE = 0.25  # of the image: a part cut out of a larger one may lie beside its principal point


# Lens models that are undone at reading, with the most coefficients each has.
LENS_MODELS = {"kannala_brandt": 4, "rational": 8}


@dataclass(frozen=True)
class LensModel:
    """A lens that `Calibration.distortion` cannot tell: see `vsgraphs.datasets.straighten`."""

    model: str
    coefficients: tuple[float, ...] = ()

    def filled(self, count: int) -> tuple[float, ...]:
        """The first `count` coefficients; those not given are 0."""
        return (*self.coefficients, *[0.0] * count)[:count]


@dataclass(frozen=True)
class Calibration:
    """Camera and depth sensor: the fields of `vsgraphs.Camera`, None where its default holds.

    `origin` says where the numbers come from.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    fps: float = 30.0
    depth_scale: float = 5000.0
    depth_min_m: float = 0.3
    depth_max_m: float = 8.0
    invalid_depth: tuple[int, ...] = (0, 65535)
    depth_noise: tuple[float, float, float] | None = None
    depth_alignment_m: float | None = None
    origin: str = "built in"
    lens: LensModel | None = None  # undone when frames are loaded

    def to_core(self) -> Any:
        """The `vsgraphs.Camera` of these numbers (loads the compiled module). Raises InputError for a camera
        that cannot be.
        """
        from vsgraphs.compiled import core

        given = {"depth_noise": self.depth_noise, "depth_alignment_m": self.depth_alignment_m}
        try:
            return core().Camera(
                self.width,
                self.height,
                self.fx,
                self.fy,
                self.cx,
                self.cy,
                distortion=self.distortion,
                fps=self.fps,
                depth_scale=self.depth_scale,
                depth_min_m=self.depth_min_m,
                depth_max_m=self.depth_max_m,
                invalid_depth=list(self.invalid_depth),
                **{key: value for key, value in given.items() if value is not None},
            )
        except ValueError as error:
            raise InputError(f"{self.origin}: {error}") from None


def check_calibration(camera: Calibration, source: str) -> None:
    """Raises InputError naming the first field that makes no sense at all. All ranges are the core's, which
    is loaded later: see `Calibration.to_core`.
    """
    for key in ("width", "height", "fx", "fy", "fps", "depth_scale", "depth_max_m"):
        if not getattr(camera, key) > 0:
            raise InputError(f"{source}: {key} is {getattr(camera, key)}, must be positive")
    if max(camera.width, camera.height) > _LARGEST_PX:
        raise InputError(
            f"{source}: {shown(camera.width)}x{shown(camera.height)} pixels, larger than any camera's"
        )
    beside = _BESIDE * camera.width, _BESIDE * camera.height
    if not (
        -beside[0] <= camera.cx <= camera.width + beside[0]
        and -beside[1] <= camera.cy <= camera.height + beside[1]
    ):
        raise InputError(f"{source}: cx, cy = {camera.cx}, {camera.cy} lies outside the image")
    if not 0 < camera.depth_min_m < camera.depth_max_m:
        raise InputError(
            f"{source}: depth_min {camera.depth_min_m} m must be above 0 and below depth_max "
            f"{camera.depth_max_m} m"
        )
