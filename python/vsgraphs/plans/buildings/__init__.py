"""Buildings of offices that look alike, made from a seed; see `docs/simulator.md`."""

from vsgraphs.plans.buildings.building import BUILDING_KINDS, building

__all__ = ["BUILDING_KINDS", "building"]
