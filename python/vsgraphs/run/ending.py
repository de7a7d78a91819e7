"""The end of a run: what is under way ends, then results and atlas are written, what matters most first."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vsgraphs.errors import is_mistake
from vsgraphs.run.output import holds_a_trajectory
from vsgraphs.run.writing import write_results

if TYPE_CHECKING:
    from vsgraphs.export.lock import Locks
    from vsgraphs.run.atlas_files import AtlasFiles
    from vsgraphs.run.beside import Beside
    from vsgraphs.run.listener import Listener
    from vsgraphs.run.opening import Opened
    from vsgraphs.run.outcome import RunOutcome
    from vsgraphs.run.result import Result
    from vsgraphs.run.result_folder import ResultFolder

# How long keyframes that still wait for the segmenter may take once all frames are tracked.
_DRAIN_LIMIT_S = 10.0


def attempt(step: Callable[[], object]) -> Exception | None:
    """Does a step; hands back its error, as what was tracked before is worth keeping."""
    try:
        step()
    except Exception as error:
        return error
    return None


def end_work(
    slam: Any,
    beside: Beside,
    stopped: Callable[[], bool],
    failure: Exception | None,
    tell: Callable[[str], None],
) -> Exception | None:
    """Has the work under way ended; the first trouble is the one to tell. failure: what ended the tracking.

    tell: what takes long.
    """
    limit_s = 0.0 if stopped() or failure is not None else _DRAIN_LIMIT_S
    draining = attempt(lambda: drain(beside, limit_s, stopped, tell))
    return failure or draining or attempt(slam.finish)


def drain(beside: Beside, limit_s: float, stopped: Callable[[], bool], tell: Callable[[str], None]) -> None:
    """What waits for a segmenter and for the search for markers; a keyframe's search takes milliseconds."""
    try:
        if (segmentation := beside.segmentation) is not None:
            waiting = segmentation.waiting
            if waiting and limit_s:
                tell(f"segmenting the last {waiting} keyframes, at most {limit_s:.0f} s")
            deadline = time.monotonic() + limit_s
            while segmentation.waiting and time.monotonic() < deadline and not stopped():
                time.sleep(0.02)  # in slices, so that Ctrl-C is answered
            segmentation.finish(0.0)
    finally:
        if beside.markers is not None:
            beside.markers.finish(limit_s)


def leave_results(
    outcome: RunOutcome,
    folder: ResultFolder,
    opened: Opened,
    failure: Exception | None,
    locks: Locks,
    listener: Listener,
) -> Result:
    """Writes results and atlas, each even where others cannot be; the result's failure is the first trouble.

    failure: what ended the tracking. A run that tracked nothing leaves an earlier run's results alone. Raises
    InputError where there is no folder for the results.
    """
    if not locks.still_holds_folder(folder.folder):
        folder.leave_alone(f"{folder.folder} was removed, and made anew by another program")
    elif not outcome.tally.tracked and holds_a_trajectory(folder.folder):
        folder.leave_alone(f"nothing was tracked: the results of an earlier run in {folder.folder} stay")
    atlas = opened.atlas
    saver = AtlasSaver(atlas, outcome.slam, listener.event)
    saving = [(str(atlas.save_to), saver.write)] if atlas.save_to is not None else []
    try:
        result = write_results(outcome, folder, saving, opened.extensions, listener)
    except Exception:
        if failure is not None:
            raise failure from None
        raise
    result.failure = failure or result.failure or folder.failure()
    return result


class AtlasSaver:
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
