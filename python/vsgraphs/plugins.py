"""What other packages add: sources, segmenters, exporters and checks, found by their entry points.

A plug-in that cannot be loaded, or fails, costs one line that names it and the cure; the others go on.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from vsgraphs.errors import InputError
from vsgraphs.reading import shown

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

KINDS = ("source", "segmenter", "exporter", "check")


@dataclass(frozen=True)
class Plugin:
    """An entry point of the group `vsgraphs.KINDs`. package: the distribution that declares it."""

    kind: str
    name: str
    package: str
    entry: EntryPoint

    def load(self) -> Callable[..., Any]:
        """The function it names. Raises InputError, in one line with the cure."""
        try:
            loaded: Any = self.entry.load()
        except (Exception, SystemExit) as error:
            raise InputError(self.trouble("cannot be loaded", error)) from None
        if not callable(loaded):
            found = TypeError(f"{self.entry.value} is no function")
            raise InputError(self.trouble("cannot be loaded", found))
        function: Callable[..., Any] = loaded
        return function

    def call(self, *arguments: Any) -> Any:
        """Loads and calls it. Raises InputError: the plug-in's own as it is, of anything else one line."""
        function = self.load()
        try:
            return function(*arguments)
        except InputError:
            raise
        except (Exception, SystemExit) as error:
            raise InputError(self.trouble("failed", error)) from error

    def trouble(self, what: str, error: BaseException) -> str:
        """One line on what went wrong with it."""
        reason = " ".join(f"{type(error).__name__}: {error}".split())[:300]
        return (
            f"{self.kind} {self.name} {what}: {reason}; update the package {self.package}, or remove it with "
            f"`pip uninstall {self.package}`"
        )


def plugins(kind: str) -> dict[str, Plugin]:
    """All that are installed, by name; nothing is loaded. Of equal names the first package's."""
    from importlib.metadata import distributions

    found: dict[tuple[str, str], Plugin] = {}
    for distribution in distributions():
        with contextlib.suppress(Exception):  # another package's damaged list of entry points
            for entry in distribution.entry_points.select(group=f"vsgraphs.{kind}s"):
                package = distribution.name
                found.setdefault((entry.name, package), Plugin(kind, entry.name, package, entry))
    ordered = sorted(found.items(), key=lambda item: item[0])
    by_name: dict[str, Plugin] = {}
    for (name, _), each in ordered:
        by_name.setdefault(name, each)
    return by_name


def plugin(kind: str, name: str, known: tuple[str, ...] = ()) -> Plugin:
    """The one of this name. known: other names to choose from. Raises InputError that lists them all."""
    found = plugins(kind)
    if name not in found:
        names = sorted({*known, *found})
        near = get_close_matches(name, names, n=1, cutoff=0.5)
        hint = f"did you mean '{near[0]}'? " if near else ""
        raise InputError(f"no {kind} {shown(name)}; {hint}known are: {', '.join(names) or 'none'}")
    return found[name]
