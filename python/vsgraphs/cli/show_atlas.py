"""`vsgraphs info`: what a saved atlas holds."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

COUNTS = ("keyframes", "landmarks", "planes", "rooms", "floors", "doors", "markers")


def show_atlas(file: Path, *, as_json: bool) -> None:
    """Prints it. Raises InputError if the file is no atlas or cannot be read."""
    from vsgraphs.compiled import core

    info = {**core().load_atlas(file).info(), "bytes": file.stat().st_size}
    print(json.dumps(info, indent=1) if as_json else _text(file, info))


def _text(file: Path, info: dict[str, Any]) -> str:
    camera = info["camera"]
    lens = ", ".join(f"{name} {camera[name]:.1f}" for name in ("fx", "fy", "cx", "cy"))
    lines = [
        f"{file}: atlas, format {info['format']}, {info['bytes'] / 1e6:.1f} MB",
        f"made by vsgraphs {info['program']}, commit {info['commit']}, mode {info['mode'] or 'unknown'}",
        f"camera {camera['width']}x{camera['height']}, {lens}",
    ]
    if not info["keyframes"]:
        return "\n".join([*lines, "an empty map"])
    header = f"{'':16}" + "".join(f"{name:>11}" for name in COUNTS)
    rows = [_row(each["name"] or f"map {i}", each) for i, each in enumerate(info["each"])]
    if info["maps"] != 1:
        rows.append(_row(f"{info['maps']} maps", info))
    return "\n".join([*lines, header, *rows])


def _row(name: str, counts: dict[str, Any]) -> str:
    return f"{name:16}" + "".join(f"{counts[key]:>11}" for key in COUNTS)
