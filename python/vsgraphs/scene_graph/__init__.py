"""3D scene graphs: typed nodes and edges, levelled, with a file format, queries and conversions."""

from vsgraphs.scene_graph.all_edges import edges_at, ordered
from vsgraphs.scene_graph.colours import CLASS_COLOURS, NO_PLANE
from vsgraphs.scene_graph.edges import Edge, Relation, node_key
from vsgraphs.scene_graph.extent import PlaneExtent, extent_of
from vsgraphs.scene_graph.file_format import (
    FORMAT,
    VERSION,
    format_scene_graph,
    load_scene_graph,
    parse_scene_graph,
)
from vsgraphs.scene_graph.frame import Frame
from vsgraphs.scene_graph.graph import SceneGraph
from vsgraphs.scene_graph.kinds import (
    KINDS,
    ROLES,
    Box,
    DoorNode,
    ElementKind,
    ElementNode,
    FloorNode,
    KeyframeNode,
    Kind,
    MarkerNode,
    PlaceNode,
    PlaneNode,
    RoomNode,
    kind_named,
    relations,
    sections,
)
from vsgraphs.scene_graph.levelling import transform_plane, transform_points, transform_poses
from vsgraphs.scene_graph.queries import RoomPath, inside_polygon
from vsgraphs.scene_graph.schema_document import scene_graph_schema

__all__ = [
    "CLASS_COLOURS",
    "FORMAT",
    "KINDS",
    "NO_PLANE",
    "ROLES",
    "VERSION",
    "Box",
    "DoorNode",
    "Edge",
    "ElementKind",
    "ElementNode",
    "FloorNode",
    "Frame",
    "KeyframeNode",
    "Kind",
    "MarkerNode",
    "PlaceNode",
    "PlaneExtent",
    "PlaneNode",
    "Relation",
    "RoomNode",
    "RoomPath",
    "SceneGraph",
    "edges_at",
    "extent_of",
    "format_scene_graph",
    "inside_polygon",
    "kind_named",
    "load_scene_graph",
    "node_key",
    "ordered",
    "parse_scene_graph",
    "relations",
    "scene_graph_schema",
    "sections",
    "transform_plane",
    "transform_points",
    "transform_poses",
]
