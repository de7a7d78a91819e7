"""What a source says of itself, with the defaults of what it leaves out."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sized
from dataclasses import dataclass
from typing import Any

from vsgraphs.datasets import Calibration
from vsgraphs.errors import InputError
from vsgraphs.sources.source import Source


@dataclass(frozen=True)
class Facts:
    """See `Source`. told: one line for people."""

    name: str
    told: str
    live: bool
    length: int | None
    info: dict[str, Any]
    streams: Mapping[str, Any]
    warnings: list[str]
    skipped: dict[str, int]


def facts_of(source: Source) -> Facts:
    """Asks a source for all that is optional. Raises InputError for what is no source or tells nonsense."""
    kind = type(source).__name__
    for needed in ("camera", "frames"):
        if not hasattr(type(source), needed) and not hasattr(source, needed):
            raise InputError(f"{kind} is no source of frames: it has no `{needed}` (docs/extending.md)")
    info = dict(getattr(source, "info", {}))
    name = str(info.setdefault("name", getattr(source, "name", kind)))
    try:
        json.dumps(info)
    except (TypeError, ValueError) as error:
        raise InputError(f"source {name}: its info cannot be written as JSON: {error}") from None
    live = bool(getattr(source, "live", False))
    length = None if live else length_of(source)
    describe = getattr(source, "describe", None)
    return Facts(
        name=name,
        told=describe() if describe is not None else _told(name, length, live=live),
        live=live,
        length=length,
        info=info,
        streams=getattr(source, "streams", {}),
        warnings=list(getattr(source, "warnings", ())),
        skipped=dict(getattr(source, "skipped", {})),
    )


def camera_of(source: Source) -> Any:
    """The source's `vsgraphs.Camera`; loads the compiled module. Raises InputError for one that cannot be."""
    camera = source.camera
    return camera.to_core() if isinstance(camera, Calibration) else camera


def length_of(source: Source) -> int | None:
    """How many frames there are, as the source says or its list of frames shows; None where nobody knows."""
    given: int | None = getattr(source, "length", None)
    if given is not None or isinstance(getattr(type(source), "frames", None), property):
        return given  # a property may be a generator that is asked for once
    frames = source.frames
    return len(frames) if isinstance(frames, Sized) else None


def _told(name: str, length: int | None, *, live: bool) -> str:
    if live:
        return f"{name}, live"
    return f"{name}: {'frames until it ends' if length is None else f'{length} frames'}"
