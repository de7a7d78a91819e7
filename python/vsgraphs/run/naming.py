"""The names that markers give to rooms and doors of a finished run."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from vsgraphs.scene_graph import SceneGraph

if TYPE_CHECKING:
    from vsgraphs.markers import KeyframeMarkers, MarkerRegistry


@dataclass
class MarkerOutcome:
    """What a run knows of markers beyond the map. warnings: of naming; there once the files were written."""

    file: str  # as the user named it
    registry: MarkerRegistry
    search: KeyframeMarkers
    warnings: list[str] = field(default_factory=list)


def named_graph(
    raw: dict[str, Any], keyframes: tuple[Any, Any, Any], markers: MarkerOutcome | None
) -> SceneGraph:
    """The map's graph (as SceneGraph.from_map); with markers, named by them."""
    if markers is None:
        return SceneGraph.from_map(raw, keyframes)
    from vsgraphs.markers import name_by_markers, told_of_two_places

    graph = SceneGraph.from_map({**raw, "markers": raw["markers"] or []}, keyframes)  # they were looked for
    markers.warnings = told_of_two_places(raw) + name_by_markers(graph, markers.registry)
    return graph


def marker_figures(markers: MarkerOutcome | None, graph: SceneGraph | None) -> dict[str, Any]:
    """run.json's section on markers; empty where none were sought."""
    if markers is None:
        return {}
    nodes = graph.markers.values() if graph is not None else ()
    mapped = [{"id": node.id, "name": node.name, "keyframes": len(node.observed_by)} for node in nodes]
    figures = {"file": markers.file, "dictionary": markers.registry.dictionary, **markers.search.report()}
    return {"markers": {**figures, "mapped": mapped}}
