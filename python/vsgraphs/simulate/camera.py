"""Which camera looks at a place: its sensor by name, its image, and effects by name."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from difflib import get_close_matches
from typing import Any

from vsgraphs.compiled import core
from vsgraphs.errors import InputError
from vsgraphs.plans import LoadedPlan
from vsgraphs.reading import shown
from vsgraphs.simulate.stream import Stream

NOISE = ("sensor", "clean")
Value = float | bool | str | list[float]
_WIDEST_DEG = 150.0
_NO_EFFECTS = ("none", "of", "validate", "seed", "sensor")
_STREAM = tuple(item.name for item in fields(Stream))


@dataclass(frozen=True)
class SimulatedCamera:
    """noise: the core's NoiseOptions; camera: its Camera; chosen: what was asked for beside the defaults."""

    noise: Any
    camera: Any
    stream: Stream
    chosen: dict[str, object]


def effect_names() -> list[str]:
    """Everything `effects` may hold."""
    options = core().NoiseOptions()
    noise = [name for name in dir(options) if not name.startswith("_") and name not in _NO_EFFECTS]
    return sorted([*noise, *_STREAM, "fov_deg"])


def simulated_camera(
    loaded: LoadedPlan,
    *,
    noise: str | Mapping[str, Any] = "sensor",
    sensor: str | None = None,
    effects: Mapping[str, Any] | None = None,
    seed: int = 0,
) -> SimulatedCamera:
    """The plan's sensor and effects, with those given here before them. InputError names the fault.

    noise: "sensor", "clean" (the sensor of that name), or effects, as older callers name them.
    """
    if isinstance(noise, str) and noise not in NOISE:
        raise InputError(f"noise must be one of {', '.join(NOISE)}, not {shown(noise)}")
    if noise == "clean":
        if sensor not in (None, "clean"):
            raise InputError(f"--noise clean measures exactly: leave --sensor {sensor} away")
        sensor = "clean"
    name = sensor or loaded.sensor or "classic"
    asked = {} if name == "clean" else dict(loaded.effects)
    asked |= noise if isinstance(noise, Mapping) else {}
    asked |= effects or {}
    if not 0 <= seed < 2**63:
        raise InputError(f"seed must lie in 0..2^63-1, not {seed}")
    try:
        options = core().NoiseOptions.of(name)
    except ValueError as error:
        raise InputError(str(error)) from None
    options.seed = seed
    stream, view = _apply(asked, options)
    camera = _camera(loaded, name, view)
    chosen: dict[str, object] = {} if name in ("classic", "clean") else {"sensor": name}
    if asked and not isinstance(noise, Mapping):
        chosen["effects"] = asked
    return SimulatedCamera(options, camera, stream, chosen)


def _apply(asked: Mapping[str, Any], options: Any) -> tuple[Stream, float | None]:
    """Sets what belongs to the core; returns the rest: what befalls the frames, and the field of view."""
    stream, view = Stream(), None
    for key, value in asked.items():
        if key in _STREAM:
            stream = replace(stream, **{key: value})
        elif key == "fov_deg":
            view = value
        else:
            _set(options, key, value)
    stream.check()
    try:
        options.validate()
    except ValueError as error:
        raise InputError(str(error)) from None
    return stream, view


def _set(options: Any, key: str, value: object) -> None:
    known = effect_names()
    if key not in known:
        near = get_close_matches(key, known, n=1, cutoff=0.6)
        hint = f"did you mean '{near[0]}'?" if near else f"known: {', '.join(known)}"
        raise InputError(f"unknown effect '{key}'; {hint}")
    wrong = InputError(f"noise.{key} cannot be {shown(value)}")
    if isinstance(value, bool) != isinstance(getattr(options, key), bool):
        raise wrong
    try:
        setattr(options, key, value)
    except TypeError:
        raise wrong from None


def _camera(loaded: LoadedPlan, sensor: str, view: object) -> Any:
    """The plan's image, otherwise the sensor's; `view`: its field of view across, degrees."""
    camera = core().sensor_camera(sensor)
    sizes = ("width", "height", "fx", "fy", "cx", "cy")
    given: dict[str, Any] = {key: getattr(camera, key) for key in sizes}
    given |= loaded.camera
    if view is not None:
        if isinstance(view, bool) or not isinstance(view, int | float) or not 10 <= view <= _WIDEST_DEG:
            raise InputError(f"fov_deg must lie in 10..{_WIDEST_DEG:g}, not {shown(view)}")
        given["fx"] = given["fy"] = given["width"] / 2 / math.tan(math.radians(view / 2))
    try:
        return core().Camera(**given, depth_min_m=camera.depth_min_m, depth_max_m=camera.depth_max_m)
    except ValueError as error:
        raise InputError(f"{loaded.source}: {error}") from None


def parse_effects(given: list[str]) -> dict[str, Any]:
    """KEY=VALUE pairs of a command line: numbers, true or false, names, numbers with commas between."""
    return dict(_parsed(pair) for pair in given)


def _parsed(pair: str) -> tuple[str, Value]:
    key, equals, text = pair.partition("=")
    if not equals or not key or not text:
        raise InputError(f"--effect {shown(pair)}: give KEY=VALUE, for instance rolling_shutter_s=0.02")
    if text in ("true", "false"):
        return key, text == "true"
    try:
        if key == "lens_k":
            return key, [float(number) for number in text.split(",")]
        return key, float(text)
    except ValueError:
        if key != "lens":
            raise InputError(f"--effect {key}: {shown(text)} is no number") from None
        return key, text
