"""Single flats and offices as hard as real ones, drawn from a seed; see `docs/simulator.md`."""

from vsgraphs.plans.drawn.draw_rooms import DRAWN_KINDS, drawn

__all__ = ["DRAWN_KINDS", "drawn"]
