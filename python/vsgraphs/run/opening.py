"""What a run is made of, opened and checked before anything is tracked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from vsgraphs.export.atomic import prepare_directory
from vsgraphs.export.lock import Locks
from vsgraphs.run.atlas_files import AtlasFiles
from vsgraphs.run.beside import Beside
from vsgraphs.run.extensions import Extensions
from vsgraphs.run.listener import Listener
from vsgraphs.run.request import RunRequest
from vsgraphs.run.watching import RunView
from vsgraphs.sources import Facts, Source, facts_of, open_source
from vsgraphs.sources.feed import Feed, feed_of, thinned_length


@dataclass
class Opened:
    """All that a run needs but the Slam. out: the directory for the results, held against others."""

    request: RunRequest
    source: Source
    facts: Facts
    beside: Beside
    atlas: AtlasFiles
    view: RunView
    extensions: Extensions
    out: Path

    @property
    def length(self) -> int | None:
        """How many frames will come; None where nobody knows."""
        return thinned_length(self.facts.length, self.request.every, self.request.max_frames)

    def feed(self, stopped: Callable[[], bool]) -> Feed:
        """The frames, on their way from now on. stopped: whether the run is told to end."""
        request = self.request
        return feed_of(
            self.source,
            live=self.facts.live,
            every=request.every,
            most=request.max_frames,
            limit_s=request.frame_timeout_s,
            stopped=stopped,
        )


def open_run(request: RunRequest, out: Path, locks: Locks, listener: Listener) -> Opened:
    """Opens all, and tells what the source says of itself. Raises InputError for the first mistake."""
    source = request.source
    if isinstance(source, str | Path):
        source = open_source(source, request.camera)
    facts = facts_of(source)
    request.check()
    beside = Beside(request, source, facts)
    extensions = Extensions(request.exporters, request.checks)
    prepare_directory(out)
    locks.hold_folder(out)
    request.check_schedule_out()
    atlas = AtlasFiles.of(request, out, locks, listener)
    view = RunView(request.showing, listener.event)
    listener.note(facts.told)
    for line in facts.warnings:
        listener.event(f"warning: {line}")
    return Opened(request, source, facts, beside, atlas, view, extensions, out)


def name_of_source(source: Source | str | Path) -> Path:
    """What a folder for its results is named after."""
    return Path(source) if isinstance(source, str | Path) else Path(facts_of(source).name)
