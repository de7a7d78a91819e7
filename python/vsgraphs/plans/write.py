"""A plan as the text of a plan file, an object a line, so that people can edit it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any


def plan_text(plan: Mapping[str, Any]) -> str:
    """JSON that `load_plan` reads. plan: as `building` returns it, or as read from a plan file."""
    return "{\n" + ",\n".join(_entry(key, value, "  ") for key, value in plan.items()) + "\n}\n"


def _entry(key: str, value: Any, indent: str) -> str:
    name = f"{indent}{json.dumps(key)}: "
    if isinstance(value, Mapping) and any(_is_list_of_objects(inner) for inner in value.values()):
        inner = ",\n".join(_entry(k, v, indent + "  ") for k, v in value.items())
        return f"{name}{{\n{inner}\n{indent}}}"
    if _is_list_of_objects(value):
        lines = ",\n".join(f"{indent}  {json.dumps(item)}" for item in value)
        return f"{name}[\n{lines}\n{indent}]"
    return name + json.dumps(value)


def _is_list_of_objects(value: object) -> bool:
    return isinstance(value, list) and any(isinstance(item, Mapping) for item in value)
