"""The JSON Schema of scene_graph.json, put together from what each kind of node says of its rows.

The file scene_graph.schema.json beside this one is its text, for others to read; tools/write_schema.py
writes it.
"""

from __future__ import annotations

import functools
import json
from typing import Any

from vsgraphs.scene_graph.kinds import KINDS, Kind, relations, rows

_HEAD = {
    "$schema": "https://json-schema.org/draft/2020-12/schema",
    "title": "vsgraphs scene graph, version 1",
    "description": "Metres, seconds. A section that is absent was not looked for; an empty one was, and "
    "nothing found.",
    "type": "object",
}
_FRAME = {
    "type": "object",
    "description": "levelled: z up, x the first camera's horizontal viewing direction, origin plumb under "
    "it. Otherwise the map's frame.",
    "required": ["levelled", "world_from_map", "ground"],
    "properties": {
        "levelled": rows.BOOLEAN,
        "world_from_map": rows.TRANSFORM,
        "ground": rows.OPTIONAL_ID,
        "zero_height": rows.TEXT,
    },
}


def scene_graph_schema() -> dict[str, Any]:
    """The schema of scene_graph.json."""
    return _assembled(tuple(KINDS))


def schema_text() -> str:
    """The text of scene_graph.schema.json."""
    return json.dumps(scene_graph_schema(), ensure_ascii=False, indent=1) + "\n"


@functools.cache
def _assembled(kinds: tuple[Kind[Any], ...]) -> dict[str, Any]:
    needed = [kind.section for kind in kinds if kind.required]
    names = "|".join(kind.name for kind in kinds)
    definitions = {**rows.COMMON, "node_key": {"type": "string", "pattern": f"^({names}):[0-9]+$"}}
    for kind in kinds:
        definitions |= {**kind.definitions, kind.name: kind.row}
    return {
        **_HEAD,
        "required": ["format", "version", "frame", *needed, "edges"],
        "properties": {
            "format": {"const": "vsgraphs scene graph"},
            "version": {"const": 1},
            "units": rows.TEXT,
            "frame": _FRAME,
            **{kind.section: rows.rows_of(kind.name) for kind in kinds},
            "edges": rows.rows_of("edge"),
        },
        "$defs": {**definitions, "edge": _edge()},
    }


def _edge() -> dict[str, Any]:
    known = relations()
    through = "|".join(dict.fromkeys(relation.via for relation in known.values() if relation.via))
    key = {"$ref": "#/$defs/node_key"}
    return rows.row_of(
        {
            "kind": {"enum": list(known)},
            "source": key,
            "target": key,
            "factor": {"type": ["string", "null"]},
            "via": {"type": ["string", "null"], "pattern": f"^{through}:[0-9]+$"},
        },
        description="A relation; factor: what holds it in the optimisation, null: nothing.",
    )
