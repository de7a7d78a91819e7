"""The door to the compiled module.

Checks the processor first, so that an old one gets a sentence and not SIGILL.
"""

from __future__ import annotations

import importlib
import os
import platform
from pathlib import Path
from typing import Any

# What x86-64-v3 adds, as Linux names it. The compiled module uses all of these without asking.
_NEEDED_FLAGS = {
    "avx2": ("avx2",),
    "bmi1": ("bmi1",),
    "bmi2": ("bmi2",),
    "fma": ("fma",),
    "f16c": ("f16c",),
    "movbe": ("movbe",),
    "lzcnt": ("abm", "lzcnt"),
}
SKIP_VARIABLE = "VSGRAPHS_SKIP_CPU_CHECK"


def core() -> Any:
    """The module `vsgraphs._core`. Raises ImportError with the reason when it cannot run here."""
    check_processor()
    try:
        return importlib.import_module("vsgraphs._core")
    except ModuleNotFoundError as error:
        if error.name != "vsgraphs._core":
            raise
        raise ImportError(
            "vsgraphs is not built: its compiled module is missing; run `pip install .`"
        ) from None


def check_processor(cpuinfo: Path = Path("/proc/cpuinfo"), machine: str | None = None) -> None:
    """Raises ImportError when an x86-64 processor (before about 2013) lacks what the module needs."""
    if (machine or platform.machine()) not in ("x86_64", "AMD64") or os.environ.get(SKIP_VARIABLE) == "1":
        return
    flags = _flags(cpuinfo)
    if flags is None:
        return
    missing = [name for name, spellings in _NEEDED_FLAGS.items() if not flags.intersection(spellings)]
    if missing:
        raise ImportError(
            f"this processor lacks {', '.join(missing)}: vsgraphs is built for x86-64-v3 (Intel Haswell, AMD "
            f"Zen and later); build it from source for this machine and set {SKIP_VARIABLE}=1"
        )


def _flags(cpuinfo: Path) -> frozenset[str] | None:
    try:
        with cpuinfo.open(encoding="ascii", errors="replace") as lines:
            for line in lines:
                if line.startswith("flags"):
                    return frozenset(line.partition(":")[2].split())
    except OSError:
        pass
    return None  # not Linux, or a container that hides it: let the module try
