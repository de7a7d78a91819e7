"""camera.yaml: the pinhole camera and depth sensor of a sequence.

Required: width, height (pixels), fx, fy, cx, cy (pixels; pixel centres at integers). Optional: distortion
([k1, k2, p1, p2, k3] or those names one by one), fps, depth_scale (raw units per metre, 5000 as in TUM
where not given), depth_min, depth_max (metres), invalid_depth (raw values), depth_noise ([offset_m,
scale_per_m, onset_m]), depth_alignment_m; model kannala_brandt (model_coefficients [k1, k2, k3, k4]) or
rational ([k1, k2, p1, p2, k3, k4, k5, k6]), which are undone when images are read. A key that looks like a
misspelt one is an error; keys that only describe (source, licence, ...) are accepted.
"""

from __future__ import annotations

import math
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from vsgraphs.datasets.calibration import LENS_MODELS, Calibration, LensModel, check_calibration
from vsgraphs.errors import InputError
from vsgraphs.reading import YAML_LIMIT, parse_yaml, read_text, shortened, shown

_INTEGERS = ("width", "height")
_REQUIRED = ("width", "height", "fx", "fy", "cx", "cy")
_NUMBERS = (
    "fx",
    "fy",
    "cx",
    "cy",
    "fps",
    "depth_scale",
    "depth_min",
    "depth_max",
    "depth_min_m",
    "depth_max_m",
    "depth_alignment_m",
)
_LENS = ("k1", "k2", "p1", "p2", "k3")
_LISTS = ("distortion", "invalid_depth", "depth_noise", "model_coefficients")
_DESCRIPTIVE = frozenset(
    [
        "source",
        "licence",
        "license",
        "scene",
        "commit",
        "timestamps",
        "rgb_depth_registered",
        "baseline_for_bf",
        "bf",
        "name",
        "model",
        "description",
        "remarks",
        "notes",
        "comment",
        "seed",
        "plan",
        "url",
        "author",
        "date",
        "unit",
    ]
)
_KNOWN = (*_INTEGERS, *_NUMBERS, *_LENS, *_LISTS)


def read_camera_file(path: Path, *, y_up: bool = False) -> tuple[Calibration, list[str]]:
    """Reads and checks a camera.yaml. Returns the calibration and remarks worth telling.

    y_up: a negative fy is how this dataset publishes its camera (ICL-NUIM); its size is taken.
    """
    values = _parse(path)
    remarks = _check_keys(path, values)
    missing = [key for key in _REQUIRED if key not in values]
    if missing:
        raise InputError(f"{path}: {', '.join(missing)} missing; a camera needs {', '.join(_REQUIRED)}")
    numbers = {key: _number(path, key, values[key]) for key in (*_INTEGERS, *_NUMBERS) if key in values}
    for plain, with_unit in (("depth_min", "depth_min_m"), ("depth_max", "depth_max_m")):
        if plain in numbers:
            numbers[with_unit] = numbers.pop(plain)
    fields: dict[str, Any] = dict(numbers)
    for key in _INTEGERS:
        if numbers[key] != int(numbers[key]):
            raise InputError(f"{path}: {key} is {numbers[key]}, expected whole pixels")
        fields[key] = int(numbers[key])
    if y_up:
        fields["fy"] = abs(fields["fy"])
    fields["distortion"], fields["lens"] = _distortion(path, values), _lens(path, values)
    if fields["lens"] is not None and any(fields["distortion"]):
        raise InputError(f"{path}: give either distortion or model_coefficients, not both")
    if "invalid_depth" in values:
        fields["invalid_depth"] = _invalid_depth(path, values["invalid_depth"])
    if values.get("depth_noise") is not None:
        fields["depth_noise"] = _depth_noise(path, values["depth_noise"])
    if "depth_scale" not in values:
        remarks.append(f"{path.name}: no depth_scale, 5000 raw units per metre (TUM) assumed")
    calibration = Calibration(**fields, origin=path.name)
    check_calibration(calibration, str(path))
    return calibration, remarks


def _parse(path: Path) -> dict[str, Any]:
    text = read_text(path, "camera file", YAML_LIMIT, expected="YAML with fx, fy, cx, cy, width, height")
    if text.startswith("%YAML:"):
        raise InputError(f"{path}: an OpenCV camera file; write plain YAML with fx, fy, cx, cy, ...")
    node = parse_yaml(text, str(path))
    if node is None or not isinstance(node.value, dict):
        raise InputError(f"{path}: expected YAML lines like 'fx: 525.0'")
    return {key: value.plain() for key, value in node.value.items()}


def _check_keys(path: Path, values: dict[str, Any]) -> list[str]:
    ignored = []
    for key in values:
        if key in _KNOWN or key in _DESCRIPTIVE:
            continue
        nearest = get_close_matches(key.lower(), _KNOWN, n=1, cutoff=0.75)
        if nearest:
            raise InputError(f"{path}: unknown key {shown(key)}; did you mean '{nearest[0]}'?")
        ignored.append(key)
    return [f"{path.name}: keys not used: {shortened(', '.join(ignored), 200)}"] if ignored else []


def _number(path: Path, key: str, value: Any) -> float:
    if isinstance(value, str):  # YAML 1.1 takes 5e3 for a word
        try:
            value = float(value)
        except ValueError:
            raise InputError(f"{path}: {key} is {shown(value)}, expected a number") from None
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InputError(f"{path}: {key} is {shown(value)}, expected a finite number")
    return float(value)


def _numbers(path: Path, key: str, value: Any) -> list[float]:
    if not isinstance(value, list | tuple):
        raise InputError(f"{path}: {key} is {shown(value)}, expected a list of numbers")
    return [_number(path, key, item) for item in value]


def _distortion(path: Path, values: dict[str, Any]) -> tuple[float, float, float, float, float]:
    if "distortion" not in values:
        k1, k2, p1, p2, k3 = (_number(path, key, values.get(key, 0.0)) for key in _LENS)
        return (k1, k2, p1, p2, k3)
    if any(key in values for key in _LENS):
        raise InputError(f"{path}: give either distortion or k1, k2, p1, p2, k3, not both")
    given = _numbers(path, "distortion", values["distortion"])
    if len(given) not in (0, 4, 5):
        raise InputError(f"{path}: distortion has {len(given)} numbers, expected 4 or 5 (k1 k2 p1 p2 k3)")
    k1, k2, p1, p2, k3 = [*given, *[0.0] * (5 - len(given))]
    return (k1, k2, p1, p2, k3)


def _lens(path: Path, values: dict[str, Any]) -> LensModel | None:
    """`model` is free text otherwise: of a camera or of its maker."""
    model = values.get("model")
    if model not in LENS_MODELS:
        if "model_coefficients" in values:
            known = " or ".join(LENS_MODELS)
            raise InputError(f"{path}: model_coefficients go with model: {known}, not {shown(model)}")
        return None
    given = _numbers(path, "model_coefficients", values.get("model_coefficients"))
    if len(given) > LENS_MODELS[model]:
        raise InputError(
            f"{path}: {model} has at most {LENS_MODELS[model]} model_coefficients, not {len(given)}"
        )
    return LensModel(model, tuple(given))


def _invalid_depth(path: Path, value: Any) -> tuple[int, ...]:
    given = _numbers(path, "invalid_depth", value if isinstance(value, list | tuple) else [value])
    if any(item != int(item) or not 0 <= item <= 65535 for item in given):
        raise InputError(f"{path}: invalid_depth {shown(value)} must hold whole numbers from 0 to 65535")
    return tuple(int(item) for item in given)


def _depth_noise(path: Path, value: Any) -> tuple[float, float, float]:
    if isinstance(value, dict):
        value = [value.get(key, 0.0) for key in ("offset_m", "scale_per_m", "onset_m")]
    given = _numbers(path, "depth_noise", value)
    if len(given) != 3 or min(given) < 0:
        raise InputError(
            f"{path}: depth_noise must be three numbers of at least 0: offset_m, scale_per_m, onset_m"
        )
    return (given[0], given[1], given[2])
