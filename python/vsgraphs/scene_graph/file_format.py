"""scene_graph.json: the graph as text and back.

Nodes carry the names of their dataclasses' fields. A section that nobody looked for is left out; an empty
one means that none was found. The schema: schema_document.py.
"""

from __future__ import annotations

import json
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

import numpy as np

from vsgraphs.errors import InputError
from vsgraphs.reading import LARGE, read_json, shown
from vsgraphs.scene_graph.all_edges import ordered
from vsgraphs.scene_graph.consistency import check_edges, check_nodes, check_references
from vsgraphs.scene_graph.edges import Edge
from vsgraphs.scene_graph.extent import PlaneExtent
from vsgraphs.scene_graph.frame import Frame
from vsgraphs.scene_graph.graph import SceneGraph
from vsgraphs.scene_graph.kinds import KINDS, Kind
from vsgraphs.scene_graph.schema import first_violation

FORMAT = "vsgraphs scene graph"
VERSION = 1
_POINT_LISTS = ("polygon", "runs")


def format_scene_graph(graph: SceneGraph) -> str:
    """The text of scene_graph.json, a node or edge per line. Equal graphs give equal bytes.

    Numbers are rounded to 1e-9: the text, not the machine's last bit, is what is kept.
    """
    frame = {**_encode(graph.frame), "zero_height": graph.frame.zero_height}
    head = {"format": FORMAT, "version": VERSION, "units": "metres, seconds", "frame": frame}
    parts = [f"{json.dumps(key)}: {_line(value)}" for key, value in head.items()]
    for kind in KINDS:
        if kind.section in graph.estimated:
            rows = [_line(_row(kind, node)) for _, node in sorted(graph.section(kind.section).items())]
            parts.append(f"{json.dumps(kind.section)}: {_block(rows)}")
    parts.append(f'"edges": {_block([_line(_encode(edge)) for edge in ordered(graph.edges)])}')
    return "{\n" + ",\n".join(parts) + "\n}\n"


def load_scene_graph(path: Path) -> SceneGraph:
    """Reads scene_graph.json. Raises InputError: missing, cut off, another format, newer, inconsistent."""
    document = read_json(path, "scene graph", LARGE, cure="was it copied completely?")
    return parse_scene_graph(document, str(path))


def parse_scene_graph(document: Any, source: str) -> SceneGraph:
    """A parsed scene_graph.json -> graph; `source` names it in errors."""
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise InputError(f'{source}: not a scene graph of vsgraphs ("format" is not "{FORMAT}")')
    version = document.get("version")
    if not isinstance(version, int) or isinstance(version, bool) or version < 1:
        raise InputError(f'{source}: "version" is {shown(version)}, expected a positive integer')
    if version > VERSION:
        raise InputError(
            f"{source}: written by a newer vsgraphs (format version {version}, this one reads up to "
            f"{VERSION}); update vsgraphs"
        )
    violation = first_violation(document)
    if violation is not None:
        raise InputError(f"{source}: {violation}")
    graph = SceneGraph(frame=_decode(Frame, document["frame"]))
    graph.estimated = frozenset(kind.section for kind in KINDS if kind.section in document)
    for kind in KINDS:
        nodes = [_decode(kind.node, row) for row in document.get(kind.section, ())]
        by_id = {node.id: node for node in sorted(nodes, key=lambda node: int(node.id))}
        graph.set_section(kind.section, by_id)
    graph.edges = ordered(_decode(Edge, row) for row in document["edges"])
    check_references(graph, source)
    check_edges(graph, source)
    check_nodes(graph, source)
    return graph


def _block(rows: list[str]) -> str:
    return "[\n" + ",\n".join(rows) + "\n]" if rows else "[]"


def _line(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, separators=(", ", ": "), allow_nan=False)


def _row(kind: Kind[Any], node: Any) -> dict[str, Any]:
    return {**_encode(node), **{name: _encode(getattr(node, name)) for name in kind.derived}}


def _encode(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return [_encode(item) for item in value.tolist()]
    if isinstance(value, bool | int | str) or value is None:
        return value
    if isinstance(value, float):
        return round(value, 9) + 0.0  # no minus zero
    if isinstance(value, dict):
        return {key: _encode(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_encode(item) for item in value]
    return {field.name: _encode(getattr(value, field.name)) for field in fields(value)}


def _decode(kind: type, row: dict[str, Any]) -> Any:
    # What came to version 1 later has a default and may be absent.
    present = [field for field in fields(kind) if field.name in row or field.default is MISSING]
    values = {field.name: row[field.name] for field in present}
    for field in present:
        value, annotation = values[field.name], str(field.type)
        if annotation == "Array":
            array = np.array(value, dtype=np.float64)
            values[field.name] = array.reshape(-1, 3) if field.name in _POINT_LISTS else array
        elif field.name == "runs":
            values[field.name] = np.array(value, dtype=np.int64).reshape(-1, 3)
        elif annotation == "PlaneExtent":
            values[field.name] = _decode(PlaneExtent, value)
        elif annotation.startswith("tuple"):
            values[field.name] = tuple(value)
        elif annotation in ("float", "float | None") and value is not None:
            values[field.name] = float(value)
    return kind(**values)
