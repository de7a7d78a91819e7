"""The pieces that schemas of a kind's rows are made of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Schema = dict[str, Any]

ID: Schema = {"$ref": "#/$defs/id"}
IDS: Schema = {"$ref": "#/$defs/ids"}
OPTIONAL_ID: Schema = {"$ref": "#/$defs/optional_id"}
VECTOR: Schema = {"$ref": "#/$defs/vector"}
TRANSFORM: Schema = {"$ref": "#/$defs/transform"}
POINTS: Schema = {"$ref": "#/$defs/points"}
NUMBER: Schema = {"type": "number"}
NUMBER_OR_NULL: Schema = {"type": ["number", "null"]}
TEXT: Schema = {"type": "string"}
BOOLEAN: Schema = {"type": "boolean"}

# Definitions that every schema of a scene graph holds.
COMMON: dict[str, Schema] = {
    "id": {"type": "integer", "minimum": 0},
    "ids": {"type": "array", "items": ID},
    "optional_id": {"type": ["integer", "null"], "minimum": 0},
    "vector": {"type": "array", "items": NUMBER, "minItems": 3, "maxItems": 3, "description": "x y z"},
    "transform": {
        "type": "array",
        "items": {"type": "array", "items": NUMBER, "minItems": 4, "maxItems": 4},
        "minItems": 4,
        "maxItems": 4,
        "description": "4x4, row by row",
    },
    "points": {"type": "array", "items": VECTOR},
}


def row_of(properties: Mapping[str, Schema], optional: tuple[str, ...] = (), description: str = "") -> Schema:
    """An object with these properties. optional: which of them may be absent, as in files of before."""
    return {
        "type": "object",
        "description": description,
        "required": [name for name in properties if name not in optional],
        "properties": dict(properties),
    }


def rows_of(definition: str) -> Schema:
    """A list of what `definition` describes."""
    return {"type": "array", "items": {"$ref": f"#/$defs/{definition}"}}
