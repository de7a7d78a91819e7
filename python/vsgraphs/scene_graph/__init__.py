"""3D scene graphs: typed nodes and edges, levelled, with a file format, queries and conversions."""

from vsgraphs.scene_graph.colours import CLASS_COLOURS, NO_PLANE
from vsgraphs.scene_graph.edges import FACTORS, Edge, node_key
from vsgraphs.scene_graph.extent import PlaneExtent, extent_of
from vsgraphs.scene_graph.file_format import (
    FORMAT,
    VERSION,
    format_scene_graph,
    load_scene_graph,
    parse_scene_graph,
)
from vsgraphs.scene_graph.graph import SceneGraph
from vsgraphs.scene_graph.levelling import transform_plane, transform_points, transform_poses
from vsgraphs.scene_graph.nodes import (
    ROLES,
    SECTIONS,
    DoorNode,
    FloorNode,
    Frame,
    KeyframeNode,
    MarkerNode,
    PlaceNode,
    PlaneNode,
    RoomNode,
)
from vsgraphs.scene_graph.queries import RoomPath, inside_polygon
from vsgraphs.scene_graph.schema import scene_graph_schema

__all__ = [
    "CLASS_COLOURS",
    "FACTORS",
    "FORMAT",
    "NO_PLANE",
    "ROLES",
    "SECTIONS",
    "VERSION",
    "DoorNode",
    "Edge",
    "FloorNode",
    "Frame",
    "KeyframeNode",
    "MarkerNode",
    "PlaceNode",
    "PlaneExtent",
    "PlaneNode",
    "RoomNode",
    "RoomPath",
    "SceneGraph",
    "extent_of",
    "format_scene_graph",
    "inside_polygon",
    "load_scene_graph",
    "node_key",
    "parse_scene_graph",
    "scene_graph_schema",
    "transform_plane",
    "transform_points",
    "transform_poses",
]
