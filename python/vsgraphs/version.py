"""Versions: of the package, of what it runs on, and the commit it was built from."""

from __future__ import annotations

import platform
from typing import Any


def version() -> str:
    """The installed package's version; "0+unknown" when run from a checkout that was never installed."""
    from importlib import metadata

    try:
        return metadata.version("vsgraphs")
    except metadata.PackageNotFoundError:
        return "0+unknown"


def versions(core: Any) -> dict[str, str]:
    """Versions that may explain a difference between two runs."""
    import numpy
    import PIL

    found = {
        "vsgraphs": version(),
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "pillow": PIL.__version__,
        "system": platform.platform(),
    }
    built: Any = getattr(core, "build_info", None)
    if callable(built):
        found.update({str(key): str(value) for key, value in built().items() if key != "commit"})
    return found


def commit(core: Any) -> str:
    """The commit the compiled module was built from, or "unknown"."""
    built: Any = getattr(core, "build_info", None)
    info = built() if callable(built) else {}
    return str(info.get("commit") or getattr(core, "__commit__", "") or "unknown")
