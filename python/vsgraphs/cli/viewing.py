"""What the command line adds to a view: a page that stays, and opening a finished run (`vsgraphs view`)."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from vsgraphs.cli.interrupt import Interrupt
from vsgraphs.run.watching import Showing

if TYPE_CHECKING:
    from vsgraphs.view import Sinks

_ARRIVE_S = 60.0  # a finished run, in the viewer: nothing else waits


def linger(sinks: Sinks | None, out: Path) -> None:
    """A page for browsers lives as long as this program: waits for Ctrl-C where somebody can press it."""
    if sinks is None or sinks.page is None:
        return
    if sys.stdin.isatty():
        wait_with_page(sinks)
    else:
        print(f"the viewer's page ends with this program; `vsgraphs view {out} --web` opens the result")
    sinks.end()


def wait_with_page(sinks: Sinks) -> None:
    """Until Ctrl-C, or until the server has ended."""
    print(f"the viewer stays open at {sinks.page} until Ctrl-C", flush=True)
    with Interrupt() as interrupt:
        while not interrupt.requested() and sinks.page is not None:
            time.sleep(0.1)
    if sinks.page is None:
        print("warning: the viewer's server has ended", file=sys.stderr, flush=True)


def view_run(folder: Path, showing: Showing) -> None:
    """`vsgraphs view`: opens a finished run. Raises InputError."""
    from vsgraphs.view import check_run, open_sinks, show_run

    check_run(folder)  # before a window opens
    sinks = open_sinks(showing.request(), lambda line: print(line, flush=True))
    show_run(folder, sinks)
    sinks.close(_ARRIVE_S)
    if sinks.record is not None:
        print(f"recorded in {sinks.record}")
    if sinks.page is not None:
        wait_with_page(sinks)
    sinks.end()
