"""What looks at keyframes beside tracking: a segmenter, a search for markers, both or neither."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vsgraphs.errors import InputError
from vsgraphs.run.naming import MarkerOutcome
from vsgraphs.sources import camera_of

if TYPE_CHECKING:
    from vsgraphs.markers import KeyframeMarkers, MarkerDetector, MarkerRegistry
    from vsgraphs.run.request import RunRequest
    from vsgraphs.segment import KeyframeSegmentation, RecordedSegmentations, Segmenter
    from vsgraphs.sources import Facts, Source


class Beside:
    """Of a request, made ready; `attach` puts it between the frames and the Slam. Raises InputError."""

    def __init__(self, request: RunRequest, source: Source, facts: Facts) -> None:
        self._segmenter = _segmenter(request.segmenter, facts)
        self._file = request.markers
        self._registry: MarkerRegistry | None = None
        self._detector: MarkerDetector | None = None
        self.segmentation: KeyframeSegmentation | None = None
        self.markers: KeyframeMarkers | None = None
        if request.markers is not None:
            from vsgraphs.markers import MarkerDetector, load_markers

            self._registry = load_markers(Path(request.markers))
            self._detector = MarkerDetector(self._registry, camera_of(source))

    def attach(self, slam: Any, config: Any, tell: Callable[[str], None]) -> Any:
        """Something with the Slam's `track`: the Slam itself where nothing was asked for.

        Within the tracker's thread where every run must be alike, beside it otherwise.
        """
        tracker = slam
        if self._detector is not None:
            from vsgraphs.markers import KeyframeMarkers

            tracker = self.markers = KeyframeMarkers(slam, self._detector, beside=not _repeatable(config))
        if self._segmenter is not None:
            from vsgraphs.segment import KeyframeSegmentation

            tracker = self.segmentation = KeyframeSegmentation(
                tracker, self._segmenter, beside=not _repeatable(config), tell=tell
            )
        return tracker

    def marker_outcome(self) -> MarkerOutcome | None:
        """What is known of markers when all is tracked; None where none were sought."""
        if self._registry is None or self.markers is None:
            return None
        return MarkerOutcome(str(self._file), self._registry, self.markers)


def _segmenter(
    wanted: str | Segmenter | RecordedSegmentations, facts: Facts
) -> Segmenter | RecordedSegmentations | None:
    if not isinstance(wanted, str):
        return wanted
    if wanted == "geometry":
        return None
    if wanted == "source":
        if "segmentations" not in facts.streams:
            raise InputError(f"--segmenter source: {facts.name} brings no segmentations of its own")
        recorded: RecordedSegmentations = facts.streams["segmentations"]
        return recorded
    from vsgraphs.segment import make_segmenter

    return make_segmenter(wanted)


def _repeatable(config: Any) -> bool:
    return config.get("system.execution") == "serial" or bool(config.get("system.replay"))


def segmenter_name(wanted: str | Segmenter | RecordedSegmentations) -> str:
    """What run.json calls it: as the user named it, or what it calls itself."""
    if isinstance(wanted, str):
        return wanted
    from vsgraphs.segment import name_of

    return name_of(wanted)
