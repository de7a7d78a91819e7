"""Plans of synthetic places: the included ones (`*.json` beside this file) and the reader for any.

`docs/simulator.md` explains the format.
"""

from vsgraphs.plans.load import LoadedPlan, load_plan, plan_names

__all__ = ["LoadedPlan", "load_plan", "plan_names"]
