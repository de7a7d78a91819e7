"""`vsgraphs info`: what a saved atlas holds."""

from __future__ import annotations

import glob
import json
import os
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any


def show_atlas(file: Path, *, as_json: bool) -> None:
    """Prints it. Raises InputError if the file is no atlas or cannot be read."""
    from vsgraphs.compiled import core

    info = {
        **core().load_atlas(file).info(),
        "bytes": file.stat().st_size,
        "kept": _kept_versions(file, core().atlas_revision),
    }
    print(json.dumps(info, indent=1) if as_json else _text(file, info))


def _text(file: Path, info: dict[str, Any]) -> str:
    camera = info["camera"]
    lens = ", ".join(f"{name} {camera[name]:.1f}" for name in ("fx", "fy", "cx", "cy"))
    lines = [
        f"{file}: atlas, format {info['format']}, {info['bytes'] / 1e6:.1f} MB",
        f"made by vsgraphs {info['program']}, commit {info['commit']}, mode {info['mode'] or 'unknown'}",
        f"camera {camera['width']}x{camera['height']}, {lens}",
    ]
    kept = [_told_kept(version, info["parent"]) for version in info["kept"]]
    if not info["keyframes"]:
        return "\n".join([*lines, "an empty map", *kept])
    counted = [key for key in info["each"][0] if key != "name"]
    header = f"{'':16}" + "".join(f"{name:>11}" for name in counted)
    rows = [_row(each["name"] or f"map {i}", each, counted) for i, each in enumerate(info["each"])]
    if info["maps"] != 1:
        rows.append(_row(f"{info['maps']} maps", info, counted))
    return "\n".join([*lines, header, *rows, *kept])


def _kept_versions(file: Path, revision: Callable[[Path], str | None]) -> list[dict[str, Any]]:
    """What `run --keep` left beside the file that the path leads to, the last version first."""
    real = Path(os.path.realpath(file))
    numbered = []
    for path in real.parent.glob(f"{glob.escape(real.name)}.*"):
        number = path.name.removeprefix(f"{real.name}.")
        if number.isdecimal() and path.is_file():
            numbered.append((int(number), path))
    return [
        {
            "file": str(path),
            "bytes": path.stat().st_size,
            "saved": datetime.fromtimestamp(path.stat().st_mtime, UTC).isoformat(timespec="seconds"),
            "revision": revision(path),
        }
        for _, path in sorted(numbered)
    ]


def _told_kept(version: dict[str, Any], parent: str | None) -> str:
    saved = datetime.fromisoformat(version["saved"]).astimezone()
    line = f"kept: {version['file']}, {version['bytes'] / 1e6:.1f} MB, saved {saved:%Y-%m-%d %H:%M:%S}"
    if version["revision"] is None:
        return f"{line}, no atlas"
    return f"{line}, what this one was made from" if version["revision"] == parent else line


def _row(name: str, counts: dict[str, Any], counted: list[str]) -> str:
    return f"{name:16}" + "".join(f"{counts[key]:>11}" for key in counted)
