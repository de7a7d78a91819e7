"""As the rest."""

from __future__ import annotations

from typing import Any

from rerun import Anything


def __getattr__(name: str) -> Any:
    return getattr(Anything, name)
