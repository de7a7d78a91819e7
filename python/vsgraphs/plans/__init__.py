"""Plans of synthetic places: the included ones (`*.json` beside this file), generated ones, and the reader
for any.

`docs/simulator.md` explains the format.
"""

from vsgraphs.plans.buildings import BUILDING_KINDS, building
from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.drawn import DRAWN_KINDS, drawn
from vsgraphs.plans.load import LoadedPlan, load_plan, plan_names, plan_path
from vsgraphs.plans.write import plan_text

__all__ = [
    "BUILDING_KINDS",
    "DRAWN_KINDS",
    "Draw",
    "LoadedPlan",
    "building",
    "drawn",
    "load_plan",
    "plan_names",
    "plan_path",
    "plan_text",
]
