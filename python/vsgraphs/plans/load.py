"""Plan files to the core's plan. Errors are one line: file, key, what is wrong, what would be right."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.plans.reader import Reader
from vsgraphs.plans.rotate import rotate
from vsgraphs.plans.schema import EXTRA_KEYS, PLAN
from vsgraphs.reading import read_json, shown

_FOLDER = Path(__file__).parent


@dataclass(frozen=True)
class LoadedPlan:
    """A plan ready for `vsgraphs._core.build_scene`, its name for messages, and the camera it asks for."""

    plan: Any  # vsgraphs._core.Plan
    source: str
    camera: dict[str, float]  # width, height, fx, fy, cx, cy as far as the plan gives them
    sensor: str | None = None  # as `simulate` names them
    effects: Mapping[str, object] = field(
        default_factory=dict
    )  # of the camera, by name; checked by `simulate`


def plan_names() -> list[str]:
    """The included plans, in alphabetical order."""
    return sorted(path.stem for path in _FOLDER.glob("*.json"))


def load_plan(source: str | Path | Mapping[str, Any]) -> LoadedPlan:
    """Reads a plan file, an included plan by name, or a plan given as nested dicts.

    Raises InputError naming the file and the key for anything that does not fit the format. Whether the place
    can be built and walked is `build_scene`'s to say.
    """
    if isinstance(source, Mapping):
        return _convert(dict(source), "plan", None)
    path = plan_path(source)
    values = read_json(path, "plan", unique=True)
    return _convert(values, str(path), path.stem)


def plan_path(source: str | Path) -> Path:
    """The file of an included plan, by name, or of any other. Raises InputError for a name unknown."""
    path = Path(source)
    if path.suffix or path.is_file() or (path.exists() and not path.is_dir()):  # a pipe: reading says so
        return path
    included = _FOLDER / f"{source}.json"  # a folder of that name beside us does not hide the included plan
    if path.name == str(source) and included.is_file():
        return included
    near = get_close_matches(str(source), plan_names(), n=1, cutoff=0.5)
    hint = f"did you mean '{near[0]}'?" if near else f"included plans: {', '.join(plan_names())}"
    raise InputError(f"there is no plan {shown(str(source))}; {hint}")


def _convert(values: object, source: str, name: str | None) -> LoadedPlan:
    if not isinstance(values, dict):
        raise InputError(f'{source}: expected an object {{"rooms": [...], "path": {{...}}}}')
    reader = Reader(source)
    rotation = reader.number(values.get("rotate_deg", 0), "rotate_deg")
    camera = reader.camera(values.get("camera", {}))
    sensor = reader.text(values["sensor"], "sensor") if "sensor" in values else None
    effects = reader.effects(values.get("effects", {}))
    plan = reader.table(PLAN, {k: v for k, v in values.items() if k not in EXTRA_KEYS}, "", EXTRA_KEYS)
    if not plan.name:
        plan.name = name or "plan"
    if rotation:
        rotate(plan, math.radians(rotation))
    return LoadedPlan(plan, source, camera, sensor, effects)
