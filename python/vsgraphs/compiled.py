"""The door to the compiled module: takes the fastest build of it that this processor runs.

A package holds the core compiled for one or for several x86-64 levels, in `_compiled/LEVEL/`. The processor
is asked first, so that one too old for all of them gets a sentence and not SIGILL.
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Collection
from pathlib import Path
from typing import Any

# Takes another installed level than the best, for example to repeat a run of an older machine.
LEVEL_VARIABLE = "VSGRAPHS_CPU"
_FOLDER = Path(__file__).parent / "_compiled"
_MODULE = "vsgraphs._core"
# Best first. Anything else ("native", "generic") was built for one machine, and is not asked about.
_X86_LEVELS = ("x86-64-v4", "x86-64-v3", "x86-64-v2")


def core() -> Any:
    """The module `vsgraphs._core`. Raises ImportError with the reason when it cannot run here."""
    import vsgraphs

    wanted = os.environ.get(LEVEL_VARIABLE)
    folder = str(_FOLDER / choose_level(installed_levels(), processor_levels(), wanted))
    if folder not in vsgraphs.__path__:
        vsgraphs.__path__.append(folder)
    return importlib.import_module(_MODULE)


def check_processor() -> None:
    """Raises ImportError when no installed build of the core runs here. Loads nothing else; under 1 ms."""
    installed = installed_levels()
    if installed:
        choose_level(installed, processor_levels(), os.environ.get(LEVEL_VARIABLE))


def installed_levels() -> list[str]:
    """What the core is installed for, in the order of the alphabet; empty where it was never built."""
    return sorted(file.parent.name for file in _FOLDER.glob("*/_core.*"))


def processor_levels() -> list[str]:
    """The x86-64 levels that processor and system run; empty on other processors and the first x86-64."""
    try:
        processor = importlib.import_module("vsgraphs._processor")
    except ModuleNotFoundError:
        return []  # not x86-64: not built
    levels: list[str] = processor.levels()
    return levels


def choose_level(installed: Collection[str], runs: Collection[str], wanted: str | None = None) -> str:
    """The best of the `installed` levels that the processor `runs`, or `wanted` where that is one.

    Raises ImportError, in one line, where there is none.
    """
    if not installed:
        raise ImportError(
            "vsgraphs is not built: its compiled module is missing; run `pip install .`", name=_MODULE
        )
    usable = [level for level in _X86_LEVELS if level in installed and level in runs]
    usable += [level for level in installed if level not in _X86_LEVELS]
    if wanted:
        if wanted not in usable:
            raise ImportError(
                f"{LEVEL_VARIABLE}={wanted}: installed are {', '.join(sorted(installed))}, of which this "
                f"processor runs {', '.join(sorted(usable)) or 'none'}; unset it to take the best",
                name=_MODULE,
            )
        return wanted
    if not usable:
        raise ImportError(
            f"this processor is too old: vsgraphs is built here for {' and '.join(sorted(installed))} "
            "(x86-64-v2: from about 2009, SSE4.2; x86-64-v3: from about 2013, AVX2); build it for this "
            "machine, from its sources: `pip install --config-settings=cmake.define.VSGRAPHS_CPU=native .`",
            name=_MODULE,
        )
    return usable[0]
