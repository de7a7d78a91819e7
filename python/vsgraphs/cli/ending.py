"""The end of a run: what is under way ends, then results and atlas are written, what matters most first."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vsgraphs.cli.failures import is_mistake
from vsgraphs.cli.output import holds_a_trajectory
from vsgraphs.cli.results import RunOutcome, write_results

if TYPE_CHECKING:
    from vsgraphs.cli.atlas_files import AtlasFiles
    from vsgraphs.cli.interrupt import Interrupt
    from vsgraphs.cli.progress import Progress
    from vsgraphs.cli.result_folder import ResultFolder
    from vsgraphs.export.lock import Locks
    from vsgraphs.markers import KeyframeMarkers
    from vsgraphs.segment import KeyframeSegmentation

# How long keyframes that still wait for the segmenter may take once all frames are tracked.
_DRAIN_LIMIT_S = 10.0


def _drain(
    segmentation: KeyframeSegmentation | None,
    markers: KeyframeMarkers | None,
    limit_s: float,
    stop: Callable[[], bool],
) -> None:
    """What waits for a segmenter and for the search for markers; a keyframe's search takes milliseconds."""
    try:
        if segmentation is not None:
            _drain_segmentation(segmentation, limit_s, stop)
    finally:
        if markers is not None:
            markers.finish(limit_s)


def _drain_segmentation(segmentation: KeyframeSegmentation, limit_s: float, stop: Callable[[], bool]) -> None:
    waiting = segmentation.waiting
    if waiting and limit_s:
        print(
            f"segmenting the last {waiting} keyframes, at most {limit_s:.0f} s", file=sys.stderr, flush=True
        )
    deadline = time.monotonic() + limit_s
    while segmentation.waiting and time.monotonic() < deadline and not stop():
        time.sleep(0.02)  # in slices, so that Ctrl-C is answered
    segmentation.finish(0.0)


def attempt(step: Callable[[], object]) -> Exception | None:
    """Does a step; hands back its error, as what was tracked before is worth keeping."""
    try:
        step()
    except Exception as error:
        return error
    return None


def end_work(
    slam: Any,
    segmentation: KeyframeSegmentation | None,
    markers: KeyframeMarkers | None,
    interrupt: Interrupt,
    failure: Exception | None,
) -> Exception | None:
    """Has the work under way ended; the first trouble is the one to tell."""
    stopped = interrupt.requested() or failure is not None
    limit_s = 0.0 if stopped else _DRAIN_LIMIT_S
    draining = attempt(lambda: _drain(segmentation, markers, limit_s, interrupt.requested))
    return failure or draining or attempt(slam.finish)


def leave_results(
    outcome: RunOutcome,
    folder: ResultFolder,
    atlas: AtlasFiles,
    failure: Exception | None,
    progress: Progress,
    locks: Locks,
) -> tuple[dict[str, Any], Exception | None]:
    """Writes results and atlas, each even where others cannot be: run.json's content, first trouble.

    A run that tracked nothing leaves an earlier run's results alone.
    """
    report: dict[str, Any] = {}
    progress.clear()
    atlas.before_a_line = progress.clear
    if not locks.still_holds_folder(folder.folder):
        folder.leave_alone(f"{folder.folder} was removed, and made anew by another program")
    elif not outcome.tally.tracked and holds_a_trajectory(folder.folder):
        folder.leave_alone(f"nothing was tracked: the results of an earlier run in {folder.folder} stay")
    saver = _AtlasSaver(atlas, outcome.slam, progress.event)
    saving = [(str(atlas.save_to), saver.write)] if atlas.save_to is not None else []
    trouble = attempt(lambda: report.update(write_results(outcome, folder, saving, progress.doing)))
    progress.clear()
    return report, failure or trouble or folder.failure()


class _AtlasSaver:
    """Saves the atlas where it was asked for; where that cannot be, among the results under a free name."""

    def __init__(self, atlas: AtlasFiles, slam: Any, tell: Callable[[str], None]) -> None:
        self._atlas, self._slam, self._tell = atlas, slam, tell
        self._saved: Path | None = None

    def write(self, folder: Path) -> None:
        """Saves, unless that was done before the results moved to another folder. Raises InputError."""
        if self._saved is not None and self._saved.is_file():
            return
        try:
            self._atlas.save(self._slam)
        except Exception as error:
            if not is_mistake(error) or not self._atlas.save_in(folder, self._slam):
                raise
            line = f"{error}; the atlas is in {self._atlas.save_to}"
            self._atlas.warnings.append(line)
            self._tell(f"warning: {line}")
        self._saved = self._atlas.save_to
