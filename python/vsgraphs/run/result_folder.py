"""Where a run's results go: into `--out`, or beside it where that cannot be written to any more."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from vsgraphs.errors import InputError, is_mistake

# Writes one file into the folder it is given. What the user can cure (no space) is raised as InputError.
Write = Callable[[Path], object]
_MOST_FOLDERS = 1000


class ResultFolder:
    """The files of a run, written in order; knows at any time which are written and which are not.

    Where the first one cannot be written, a new folder beside is made (`results-2`, the first that is free),
    and all of them go there. What can be written nowhere is left out and named in the end.

    names: the files that will be written, for `last_words` before `write` has come to them. tell: for lines
    a person should see. hold: keeps other programs out of a folder that was made beside.
    """

    def __init__(
        self,
        out: Path,
        names: Sequence[str],
        tell: Callable[[str], None],
        hold: Callable[[Path], object] = lambda _: None,
    ) -> None:
        self.folder = self._out = out
        # As long as there is a working directory; "." has no name.
        self._absolute = out.absolute() if out.name not in ("", "..") else out.resolve()
        self.warnings: list[str] = []
        self._names = list(dict.fromkeys(names))
        self._tell, self._hold = tell, hold
        self._written: dict[str, Write] = {}
        self._missing: dict[str, str] = {}  # and why
        self._defect: Exception | None = None

    def write(self, files: Iterable[tuple[str, Write]], show: Callable[[str], None]) -> None:
        """Writes the files, whatever becomes of any of them. show: what is being written."""
        for name, write in files:
            show(f"writing {name}")
            trouble = self._attempt(name, write, self.folder)
            if isinstance(trouble, InputError) and self.folder == self._out:
                self._move(name, write, trouble)

    def leave_alone(self, why: str) -> None:
        """Nothing is written into the folder the user named, but into a new one beside. Raises InputError."""
        try:
            self.folder = new_folder_beside(self._absolute)
        except OSError as error:
            raise InputError(f"{why}; no folder can be made beside it: {error.strerror or error}") from None
        self._hold(self.folder)
        self.warnings.append(f"{why}; what this run left is in {self.folder}")
        self._tell(f"warning: {self.warnings[-1]}")

    def failure(self) -> Exception | None:
        """What is to be told: a defect of ours before files that are missing, which are named."""
        if self._defect is not None or not self._missing:
            return self._defect
        (_, reason), *others = self._missing.items()
        return InputError(
            reason
            + (f", nor {', '.join(name for name, _ in others)}" if others else "")
            + (f"; written: {', '.join(self._written)}" if self._written else "; nothing was written")
        )

    def files(self) -> dict[str, Path]:
        """What is written, by its last name, and where it is."""
        named = [
            (Path(name), self.folder / name) for name in self._written
        ]  # an atlas is where it was asked for
        paths = [path if path.is_file() else other for other, path in named]
        return {path.name: path for path in paths if path.is_file()}

    def last_words(self) -> str:
        """For a process that ends now."""
        written = [name for name in self._names if name in self._written]
        rest = [name for name in self._names if name not in self._written]
        return (f"written in {self.folder}: {', '.join(written)}" if written else "nothing was written") + (
            f"; not written: {', '.join(rest)}" if rest else ""
        )

    def _attempt(self, name: str, write: Write, folder: Path) -> Exception | None:
        try:
            write(folder)
        except Exception as error:
            told = error if isinstance(error, InputError) else None
            if told is None and is_mistake(error):
                told = InputError(str(error))
            if told is None:
                self._defect = self._defect or error
            self._missing[name] = str(error)
            return told or error
        self._missing.pop(name, None)
        self._written[name] = write
        return None

    def _move(self, name: str, write: Write, trouble: InputError) -> None:
        """All that was written so far, too: half of the results here and half there help nobody."""
        try:
            beside = new_folder_beside(self._absolute)
        except OSError:
            return
        self.warnings.append(f"{trouble}; the results are in {beside}")
        if self._attempt(name, write, beside) is not None:
            self._missing[name] = str(trouble)
            self.warnings.pop()
            with contextlib.suppress(OSError):
                beside.rmdir()
            return
        self.folder = beside
        self._hold(beside)
        self._tell(f"warning: {self.warnings[-1]}")
        for earlier, again in list(self._written.items()):
            if earlier != name and self._attempt(earlier, again, beside) is not None:
                self._still_in_the_old_one(earlier)

    def _still_in_the_old_one(self, name: str) -> None:
        if (self._out / name).is_file():
            self._missing.pop(name)
            self.warnings.append(f"{name} is in {self._out}")
        else:
            self._written.pop(name)


def new_folder_beside(folder: Path) -> Path:
    """Makes `NAME-2`, or -3, ...: the first that is free; parents that are gone, too. Raises OSError."""
    for number in itertools.count(2):
        beside = folder.with_name(f"{folder.name}-{number}")
        try:
            beside.mkdir(parents=True)
        except FileExistsError:
            if number > _MOST_FOLDERS:
                raise
        else:
            return beside
    raise AssertionError
