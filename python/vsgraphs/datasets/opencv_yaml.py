"""YAML as OpenCV writes it: its `%YAML:1.0` line and its matrices, which YAML readers do not take."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from vsgraphs.errors import InputError

_MATRIX = "tag:yaml.org,2002:opencv-matrix"


def read_opencv_yaml(path: Path) -> dict[str, Any]:
    """The file's mapping; matrices as (rows, cols) float64 arrays. Raises InputError."""
    import yaml

    class Loader(yaml.SafeLoader):
        """Knows OpenCV's matrices."""

    def matrix(loader: Loader, node: yaml.MappingNode) -> Any:
        values = loader.construct_mapping(node, deep=True)
        data = np.array(values["data"], dtype=np.float64)
        return data.reshape(int(values["rows"]), int(values["cols"]))

    Loader.add_constructor(_MATRIX, matrix)
    try:
        text = path.read_text(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    if text.startswith("%YAML:"):
        text = text.partition("\n")[2]
    try:
        values = yaml.load(text, Loader=Loader)  # noqa: S506  (a SafeLoader)
    except (yaml.YAMLError, KeyError, TypeError, ValueError) as error:
        mark = getattr(error, "problem_mark", None)
        where = f" near line {mark.line + 2}" if mark else ""
        reason = getattr(error, "problem", None) or str(error).splitlines()[0]
        raise InputError(f"{path}: not a YAML file of OpenCV{where} ({reason})") from None
    if not isinstance(values, dict):
        raise InputError(f"{path}: expected the YAML that OpenCV writes, with a name on each line")
    return values
