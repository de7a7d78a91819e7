"""A plan becomes a recorded sequence: TUM RGB-D layout plus exact truth; see `docs/simulator.md`."""

from vsgraphs.simulate.camera import NOISE, effect_names
from vsgraphs.simulate.options import Output
from vsgraphs.simulate.run import Simulation, simulate

__all__ = ["NOISE", "Output", "Simulation", "effect_names", "simulate"]
