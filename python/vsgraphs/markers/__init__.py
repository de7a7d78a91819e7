"""Fiducial markers (ArUco): found on keyframes, mapped as landmarks, naming rooms and doors. Optional."""

from vsgraphs.markers.detector import Detections, MarkerDetector
from vsgraphs.markers.keyframes import KeyframeMarkers
from vsgraphs.markers.naming import name_by_markers, told_of_two_places
from vsgraphs.markers.registry import DICTIONARIES, KINDS, MarkerRegistry, NamedMarker, load_markers

__all__ = [
    "DICTIONARIES",
    "KINDS",
    "Detections",
    "KeyframeMarkers",
    "MarkerDetector",
    "MarkerRegistry",
    "NamedMarker",
    "load_markers",
    "name_by_markers",
    "told_of_two_places",
]
