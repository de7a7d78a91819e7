"""What a run has when all is tracked and nothing is written yet."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from vsgraphs.export.timeline import Span
    from vsgraphs.markers import KeyframeMarkers
    from vsgraphs.run.naming import MarkerOutcome
    from vsgraphs.run.session import Tally
    from vsgraphs.run.watching import RunView
    from vsgraphs.segment import KeyframeSegmentation
    from vsgraphs.sources import Facts


@dataclass
class RunOutcome:
    """A finished run, before it is written."""

    source: Facts
    config: Any
    slam: Any
    tally: Tally
    frames: int
    wall_s: float
    startup_s: float | None
    cpu_before_s: float = 0.0  # of the process, when the run began
    map_colours: str = "image"  # of map.ply: image or class
    segmenter: str = "geometry"  # as the user named it
    segmentation: KeyframeSegmentation | None = None
    view: RunView | None = None
    markers: MarkerOutcome | None = None
    warnings: list[str] = field(default_factory=list)  # of saving meanwhile

    def told(self) -> list[str]:
        """All warnings so far but the core's."""
        beside: list[KeyframeSegmentation | RunView | KeyframeMarkers | MarkerOutcome | None]
        beside = [self.segmentation, self.view]
        beside += [self.markers.search, self.markers] if self.markers else []
        lines = [*self.source.warnings, *self.tally.warnings, *self.warnings]
        return lines + [line for part in beside if part is not None for line in part.warnings]

    def spans(self) -> list[Span]:
        """What ran when, for the timeline."""
        spans: list[Span] = [tuple(span) for span in self.slam.trace()]
        spans += [("decoding", "decode", *span) for span in self.tally.decode_spans]
        if self.markers is not None:
            spans += [("markers", "search", *span) for span in self.markers.search.spans]
        if self.segmentation is not None:
            spans += [("segmentation", "segment", *span) for span in self.segmentation.spans]
        return spans
