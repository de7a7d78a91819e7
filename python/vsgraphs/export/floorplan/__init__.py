"""floorplan.svg."""

from vsgraphs.export.floorplan.drawing import format_floorplan

__all__ = ["format_floorplan"]
