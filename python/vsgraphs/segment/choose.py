"""`--segmenter TEXT` -> a segmenter."""

from __future__ import annotations

import os
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

from vsgraphs.errors import InputError
from vsgraphs.plugins import plugins
from vsgraphs.reading import plain_value, shortened, shown

if TYPE_CHECKING:
    from vsgraphs.segment.segmentation import RecordedSegmentations, Segmenter

GEOMETRY = "geometry"
MODELS_VARIABLE = "VSGRAPHS_MODELS"
_KINDS = (GEOMETRY, "onnx", "labels")
_ONNX_OPTIONS = ("sidecar", "threads", "provider", "limit")


def make_segmenter(text: str) -> Segmenter | RecordedSegmentations | None:
    """'geometry' -> None (surfaces are told apart by geometry alone), 'onnx:FILE[,sidecar=FILE][,threads=N]
    [,provider=NAME][,limit=SECONDS]', 'labels:DIR', or 'NAME[:TEXT]' of a plug-in. Raises InputError.
    """
    kind, colon, rest = text.partition(":")
    if kind == GEOMETRY and not colon:
        return None
    if kind not in _KINDS and kind in (others := plugins("segmenter")):
        made: Segmenter | RecordedSegmentations = others[kind].call(rest)
        return made
    if kind not in _KINDS or kind == GEOMETRY:
        near = get_close_matches(kind, _KINDS, n=1, cutoff=0.5)
        hint = f"did you mean '{near[0]}'? " if near and near[0] != kind else ""
        raise InputError(f"--segmenter {shortened(text)}: {hint}expected geometry, onnx:FILE or labels:DIR")
    if not rest:
        raise InputError(
            f"--segmenter {shortened(text)}: expected {kind}:{'FILE' if kind == 'onnx' else 'DIR'}"
        )
    if kind == "labels":
        from vsgraphs.segment.label_folder import LabelFolder

        return LabelFolder(Path(rest))
    return _onnx(rest, f"--segmenter {shortened(text)}")


def _onnx(rest: str, where: str) -> Segmenter:
    from vsgraphs.segment.onnx_model import OnnxSegmenter, Runtime

    file, *settings = rest.split(",")
    given = {}
    for setting in settings:
        key, equals, value = setting.partition("=")
        if not equals or not value:
            raise InputError(f"{where}: expected KEY=VALUE after a comma, not {shown(setting)}")
        if key not in _ONNX_OPTIONS:
            near = get_close_matches(key, _ONNX_OPTIONS, n=1, cutoff=0.5)
            hint = f"did you mean '{near[0]}'?" if near else f"known are {', '.join(_ONNX_OPTIONS)}"
            raise InputError(f"{where}: unknown key {shown(key)}; {hint}")
        given[key] = value
    model = find_model_file(file)
    sidecar = find_model_file(given["sidecar"]) if "sidecar" in given else model.with_suffix(".json")
    if not sidecar.exists() and "sidecar" not in given and model.is_file():
        raise InputError(
            f"{where}: the sidecar {sidecar} is missing; write it, or name it: "
            f"onnx:{file},sidecar=FILE (docs/segmentation.md)"
        )
    threads = given.get("threads", "1")
    if not threads.isdecimal() or len(threads) > 3 or not 1 <= int(threads) <= 256:
        raise InputError(f"{where}: threads must be 1 to 256, not {shown(threads)}")
    limit_s = plain_value(given.get("limit", str(Runtime.limit_s)))
    if isinstance(limit_s, bool | str) or not 0 < limit_s <= 3600:
        raise InputError(f"{where}: limit must be up to 3600 seconds, not {shown(given['limit'])}")
    provider = given.get("provider", Runtime.provider)
    return OnnxSegmenter(model, sidecar, Runtime(int(threads), provider, float(limit_s)))


def find_model_file(name: str) -> Path:
    """The file of that name here or, for a relative name, in the folder VSGRAPHS_MODELS names. InputError."""
    try:
        here = Path(name).expanduser()
    except RuntimeError:  # ~somebody, of whom this machine knows nothing
        here = Path(name)
    if not here.name:
        raise InputError(f"{shown(name)} is not the name of a file")
    models = os.environ.get(MODELS_VARIABLE)
    if here.is_absolute() or here.exists():
        return here
    if not models:
        raise InputError(f"{shortened(name)} is missing ({MODELS_VARIABLE} may name a folder to look in)")
    there = Path(models) / here
    if not there.exists():
        raise InputError(f"{shortened(name)} is neither here nor in {models} ({MODELS_VARIABLE})")
    return there
