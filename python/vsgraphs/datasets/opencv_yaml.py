"""YAML as OpenCV writes it: its `%YAML:1.0` line and its matrices, which YAML readers do not take."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from vsgraphs.errors import InputError
from vsgraphs.reading import YAML_LIMIT, YamlNode, parse_yaml, read_text

_MATRIX = "tag:yaml.org,2002:opencv-matrix"


def read_opencv_yaml(path: Path) -> dict[str, Any]:
    """The file's mapping; matrices as (rows, cols) float64 arrays. Raises InputError."""
    text = read_text(path, "file", YAML_LIMIT, expected="the YAML that OpenCV writes", damaged=True)
    if text.startswith("%YAML:"):
        text = "\n" + text.partition("\n")[2]  # lines keep their numbers
    node = parse_yaml(text, str(path), unique=False, tags=(_MATRIX,))
    if node is None or not isinstance(node.value, dict):
        raise InputError(f"{path}: expected the YAML that OpenCV writes, with a name on each line")
    return {key: _value(value, path) for key, value in node.value.items()}


def _value(node: YamlNode, path: Path) -> Any:
    if node.tag == _MATRIX:
        return _matrix(node, path)
    if isinstance(node.value, dict):
        return {key: _value(value, path) for key, value in node.value.items()}
    if isinstance(node.value, list):
        return [_value(value, path) for value in node.value]
    return node.plain()


def _matrix(node: YamlNode, path: Path) -> Any:
    values = node.plain()
    try:
        data = np.array([float(number) for number in values["data"]])
        rows, cols = int(values["rows"]), int(values["cols"])
        return data.reshape(max(rows, 0), max(cols, 0))
    except (KeyError, TypeError, ValueError, OverflowError):
        raise InputError(
            f"{path}:{node.line}: not a matrix as OpenCV writes it: rows, cols and as many numbers as data"
        ) from None
