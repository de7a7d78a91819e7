"""Checks a parsed file against the JSON Schema (draft 2020-12), of which we use a small part.

Understood: type, const, enum, required, properties, additionalProperties (as a schema), items, minItems,
maxItems, minimum, pattern, $ref into $defs. Stricter in one thing: 1.0 is no integer. Tests check our
answers against the package jsonschema.
"""

from __future__ import annotations

import math
import re
from typing import Any

from vsgraphs.reading import shown
from vsgraphs.scene_graph.schema_document import scene_graph_schema

_LARGEST = 1e12  # of metres, seconds, ids: its square is still a number
_TYPES: dict[str, type | tuple[type, ...]] = {
    "object": dict,
    "array": list,
    "string": str,
    "boolean": bool,
    "integer": int,
    "number": (int, float),
    "null": type(None),
}


def first_violation(document: Any) -> str | None:
    """The first thing in `document` that departs from the schema, as a line with its place; or None."""
    return _check(document, scene_graph_schema(), "")


def _check(value: Any, rule: dict[str, Any], where: str) -> str | None:
    if "$ref" in rule:
        return _check(value, scene_graph_schema()["$defs"][rule["$ref"].rpartition("/")[2]], where)
    problem = _check_value(value, rule)
    if problem is not None:
        return f"{where or 'the file'} {problem}"
    if isinstance(value, dict):
        return _check_object(value, rule, where)
    if isinstance(value, list) and "items" in rule:
        found = (_check(item, rule["items"], f"{where}[{i}]") for i, item in enumerate(value))
        return next((problem for problem in found if problem), None)
    return None


def _check_object(value: dict[str, Any], rule: dict[str, Any], where: str) -> str | None:
    for name in rule.get("required", ()):
        if name not in value:
            return f"{where or 'the file'} has no '{name}'"
    for name, item in value.items():
        below = rule.get("properties", {}).get(name, rule.get("additionalProperties"))
        problem = _check(item, below, f"{where}.{name}" if where else name) if below else None
        if problem:
            return problem
    return None


def _check_value(value: Any, rule: dict[str, Any]) -> str | None:  # noqa: PLR0911  (one line a keyword)
    if "type" in rule:
        wanted = [rule["type"]] if isinstance(rule["type"], str) else rule["type"]
        if not any(_is(value, name) for name in wanted):
            return f"must be {' or '.join(wanted)}, not {shown(value)}"
    if "const" in rule and (value != rule["const"] or isinstance(value, bool)):  # only Python has True == 1
        return f"must be {shown(rule['const'])}"
    if "enum" in rule and value not in rule["enum"]:
        return f"must be one of {', '.join(map(str, rule['enum']))}, not {shown(value)}"
    if isinstance(value, list):
        least, most = rule.get("minItems", 0), rule.get("maxItems", math.inf)
        if not least <= len(value) <= most:
            return f"has {len(value)} items, expected {least if least == most else f'at least {least}'}"
    if "minimum" in rule and isinstance(value, int | float) and value < rule["minimum"]:
        return f"is {shown(value)}, at least {rule['minimum']} expected"
    if "pattern" in rule and isinstance(value, str) and not re.search(rule["pattern"], value):
        return f"is {shown(value)}, expected the pattern {rule['pattern']}"
    return None


def _is(value: Any, name: str) -> bool:
    if isinstance(value, bool):
        return name == "boolean"
    if isinstance(value, int | float) and not abs(value) <= _LARGEST:
        return False  # nor is NaN a number, which Python reads and JSON has not
    return isinstance(value, _TYPES[name])
