"""Where a run's results go."""

from __future__ import annotations

import contextlib
import itertools
import os
from collections.abc import Callable, Collection, Iterator
from pathlib import Path

from vsgraphs.errors import InputError
from vsgraphs.reading import read_json
from vsgraphs.run.summary import RESULT_FILES

_SUFFIX = "_vsgraphs"
_LONGEST = 200  # bytes of a name; file systems take 255


@contextlib.contextmanager
def results_folder(out: Path | None, source: Path) -> Iterator[Path]:
    """The directory the user named, or else a new one named after the source, in the working directory.

    A new one that stays empty is removed in the end. Raises InputError where it cannot be created.
    """
    if out is not None:
        yield out
        return
    folder = _new_folder(source)
    try:
        yield folder
    finally:
        with contextlib.suppress(OSError):
            folder.rmdir()  # refuses unless it is empty


def _new_folder(source: Path) -> Path:
    """Creates NAME_vsgraphs, or NAME_vsgraphs-2, -3, ...: mkdir lets only one program have a number."""
    name = _safe(Path(os.path.realpath(source)).name) + _SUFFIX
    for number in itertools.count(1):
        folder = Path(name if number == 1 else f"{name}-{number}")
        try:
            folder.mkdir()
        except FileExistsError:
            continue
        except OSError as error:
            raise InputError(
                f"cannot create {folder} in {Path.cwd()}: {error.strerror or error}; "
                "name a directory with --out"
            ) from None
        return folder
    raise AssertionError  # the count has no end


def _safe(name: str) -> str:
    """A name that every file system and shell takes: letters, digits, . _ -, in front a letter or digit."""
    kept = "".join(c if c.isalnum() or c in "._-" else "_" for c in name).lstrip(".-_")
    return kept.encode()[:_LONGEST].decode(errors="ignore") or "sequence"


def holds_a_trajectory(out: Path) -> bool:
    """Whether an earlier run that tracked something left its results; True where it cannot be known."""
    if not os.path.lexists(out / "run.json"):
        return False
    try:
        report = read_json(out / "run.json", "figures of a run")
    except InputError:
        return True
    return not isinstance(report, dict) or report.get("tracked") != 0


def remove_earlier(out: Path, written: Collection[str], tell: Callable[[str], object]) -> None:
    """Removes what an earlier run left in `out` and this one does not write, as nobody could tell them apart.

    Only where a run.json says that there was a run; nothing but a run's own files. tell: what was removed.
    """
    if not (out / "run.json").is_file():
        return
    stale = [name for name in RESULT_FILES if name not in written and (out / name).is_file()]
    for name in stale:
        with contextlib.suppress(OSError):
            (out / name).unlink()
    if stale:
        tell(f"removed from {out}, of an earlier run: {', '.join(stale)}")
