"""The door to Rerun, which need not be installed."""

from __future__ import annotations

import importlib
from typing import Any

from vsgraphs.errors import InputError


def rerun() -> Any:
    """The module `rerun`. Raises InputError where it is not installed."""
    try:
        return importlib.import_module("rerun")
    except ImportError as error:
        reason = "" if isinstance(error, ModuleNotFoundError) and error.name == "rerun" else f" ({error})"
        raise InputError(f"the viewer is not installed{reason}; pip install 'vsgraphs[viz]'") from None


def blueprint() -> Any:
    """The module `rerun.blueprint`."""
    rerun()
    return importlib.import_module("rerun.blueprint")
