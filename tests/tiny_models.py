"""Networks of a few bytes: each output a constant, or computed from the image by one operator."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

SHAPE = ("n", 3, "h", "w")


def save_model(
    path: Path,
    nodes: list[onnx.NodeProto],
    outputs: list[str],
    constants: dict[str, np.ndarray] | None = None,
    image: tuple[Any, ...] = SHAPE,
    dtype: int = TensorProto.FLOAT,
) -> Path:
    """A model with the input `image`."""
    made = {node.output[0] for node in nodes}
    nodes = nodes + [
        helper.make_node("Identity", [name], [f"{name}_out"]) for name in outputs if name not in made
    ]
    names = [name if name in made else f"{name}_out" for name in outputs]
    graph = helper.make_graph(
        nodes,
        "tiny",
        [helper.make_tensor_value_info("image", dtype, image)],
        [onnx.ValueInfoProto(name=name) for name in names],
        [numpy_helper.from_array(value, name) for name, value in (constants or {}).items()],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)])
    model.ir_version = 8
    onnx.save(onnx.shape_inference.infer_shapes(model), path)
    return path


def constant_model(path: Path, outputs: dict[str, np.ndarray], **options: Any) -> Path:
    """Gives `outputs` (named NAME_out) whatever the image."""
    return save_model(path, [], list(outputs), outputs, **options)


def colour_model(path: Path, **options: Any) -> Path:
    """Gives the preprocessed image itself as scores of three classes, output `scores`."""
    return save_model(path, [helper.make_node("Identity", ["image"], ["scores"])], ["scores"], **options)


def write_sidecar(path: Path, **changes: Any) -> Path:
    """A sidecar for `colour_model`; top-level keys as given, None takes one out."""
    sidecar: dict[str, Any] = {
        "input": {"layout": "NCHW", "size": [8, 6]},
        "output": {"kind": "semantic", "scores": "scores"},
        "classes": ["wall", "floor", "sofa"],
        "roles": {"wall": "wall", "floor": "ground"},
        **changes,
    }
    path.write_text(json.dumps({key: value for key, value in sidecar.items() if value is not None}))
    return path
