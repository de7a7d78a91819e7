"""Segmentation by an ONNX model on ONNX Runtime (extra `onnx`)."""

from __future__ import annotations

import threading
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

from vsgraphs.errors import InputError
from vsgraphs.reading import open_regular, shortened, shown
from vsgraphs.segment.onnx_outputs import interpret
from vsgraphs.segment.segmentation import Rgb, Segmentation, checked
from vsgraphs.segment.sidecar import LARGEST_SIDE, Sidecar, read_sidecar

_DTYPES = {"tensor(float)": np.float32, "tensor(float16)": np.float16, "tensor(uint8)": np.uint8}


@dataclass(frozen=True)
class Runtime:
    """How the network is computed, which depends on the machine and not on the model."""

    threads: int = 1  # the tracker and the mapper want the other cores
    provider: str = "CPUExecutionProvider"
    limit_s: float = 10.0  # of one image: a network may hold a loop without an end


class OnnxSegmenter:
    """Calls a model as its sidecar says. One black image is segmented on construction, so that a sidecar that
    does not fit the model is known before the first frame.

    Raises InputError in one line: file missing or no model, unknown provider, sidecar wrong or not of this
    model, onnxruntime not installed.
    """

    def __init__(self, model: Path, sidecar: Path, runtime: Runtime | None = None) -> None:
        self.name = model.name
        if not model.exists():
            raise InputError(f"model {model} is missing")
        open_regular(model, "model").close()
        self._runtime = runtime or Runtime()
        self._sidecar = read_sidecar(sidecar)
        self._session = _open(model, self._runtime)
        try:
            self._input, self._dtype, self._size = _input_of(self._session, self._sidecar, model)
            self._outputs = _outputs_of(self._session, self._sidecar)
        except UnicodeDecodeError:
            raise InputError(f"model {model} is damaged: a name in it is no text") from None
        width, height = self._size or (64, 64)
        checked(self(np.zeros((height, width, 3), np.uint8)), self.name)

    def __call__(self, rgb: Rgb, /) -> Segmentation:
        """Segments (H, W, 3) uint8; the result has the size of the network's output."""
        found = dict(zip(self._outputs, self._run(self._blob(rgb)), strict=True))
        for part, tensor in found.items():
            if not isinstance(tensor, np.ndarray) or tensor.dtype.kind not in "fiub":
                kind = tensor.dtype if isinstance(tensor, np.ndarray) else type(tensor).__name__
                raise InputError(f"{self._sidecar.path}: output '{part}' is {kind}, expected numbers")
        with np.errstate(all="ignore"):  # what is no number is found by `checked`
            return interpret(found, self._sidecar)

    def _run(self, blob: npt.NDArray[Any]) -> list[Any]:
        from onnxruntime import RunOptions

        options = RunOptions()
        options.log_severity_level = 4
        over = threading.Timer(self._runtime.limit_s, setattr, (options, "terminate", True))
        over.daemon = True
        over.start()
        try:
            found: list[Any] = self._session.run(list(self._outputs.values()), {self._input: blob}, options)
        except Exception as error:  # ONNX Runtime's errors have no common class of their own
            if options.terminate:
                raise InputError(
                    f"model {self.name} takes more than {self._runtime.limit_s:g} s for an image, stopped; "
                    "it may loop for ever, else give it time: onnx:FILE,limit=SECONDS"
                ) from None
            raise InputError(f"model {self.name} cannot be run: {_first_line(error)}") from None
        finally:
            over.cancel()
        return found

    def _blob(self, rgb: Rgb) -> npt.NDArray[Any]:
        given = self._sidecar.input
        pixels = rgb
        if self._size is not None and (rgb.shape[1], rgb.shape[0]) != self._size:
            pixels = np.asarray(Image.fromarray(rgb).resize(self._size, Image.Resampling.BILINEAR))
        if given.colour == "bgr":
            pixels = pixels[:, :, ::-1]
        if (given.scale, given.mean, given.std) != (1.0, (0, 0, 0), (1, 1, 1)):
            mean, std = np.array(given.mean, np.float32), np.array(given.std, np.float32)
            pixels = (pixels * (np.float32(given.scale) / std) - mean / std).astype(np.float32)
        if given.layout == "NCHW":
            pixels = np.moveaxis(pixels, 2, 0)
        return np.ascontiguousarray(pixels[None], self._dtype)


def _open(model: Path, runtime: Runtime) -> Any:
    try:
        import onnxruntime
    except ImportError:
        raise InputError(
            "--segmenter onnx needs ONNX Runtime: install the extra with `pip install 'vsgraphs[onnx]'`"
        ) from None
    available = onnxruntime.get_available_providers()
    if runtime.provider not in available:
        raise InputError(
            f"this ONNX Runtime has no provider '{runtime.provider}'; it has {', '.join(available)}"
        )
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = runtime.threads
    options.inter_op_num_threads = 1
    options.log_severity_level = 4  # what goes wrong comes as an exception
    options.add_session_config_entry(
        "session.intra_op.allow_spinning", "0"
    )  # threads that wait must not burn CPU
    try:
        return onnxruntime.InferenceSession(str(model), options, providers=[runtime.provider])
    except Exception as error:  # as in OnnxSegmenter.__call__
        raise InputError(
            f"model {model} is not an ONNX model this runtime can load: {_first_line(error)}"
        ) from None


def _input_of(session: Any, sidecar: Sidecar, model: Path) -> tuple[str, Any, tuple[int, int] | None]:
    """(name, dtype, size) of the input; size (width, height) None where neither file fixes it."""
    inputs = {value.name: value for value in session.get_inputs()}
    if not inputs:
        raise InputError(f"model {model}: takes no input; a segmenter takes one, the image")
    name = sidecar.input.name or next(iter(inputs))
    if name not in inputs:
        raise InputError(
            f"{sidecar.path}: input {shown(name)} is not of {model.name}, which has {_listed(inputs)}"
        )
    if len(inputs) > 1:
        raise InputError(f"model {model}: has the inputs {_listed(inputs)}; only one, the image, can be fed")
    value = inputs[name]
    if value.type not in _DTYPES:
        raise InputError(
            f"model {model}: input {shown(name)} is {value.type}, expected float, float16 or uint8"
        )
    shape = list(value.shape)
    channels, rows, columns = (1, 2, 3) if sidecar.input.layout == "NCHW" else (3, 1, 2)
    if len(shape) != 4 or (isinstance(shape[channels], int) and shape[channels] != 3):
        raise InputError(
            f"{sidecar.path}: input {shown(name)} has shape {shown(shape)}, "
            f"that is not {sidecar.input.layout} with 3 colours"
        )
    if isinstance(shape[0], int) and shape[0] != 1:
        raise InputError(f"model {model}: takes {shape[0]} images at once; export it for 1")
    fixed = (shape[columns], shape[rows])
    for side in fixed:
        if isinstance(side, int) and not 1 <= side <= LARGEST_SIDE:
            raise InputError(
                f"model {model}: takes images of {fixed[0]}x{fixed[1]} pixels; sides are 1 to {LARGEST_SIDE}"
            )
    wanted = sidecar.input.size
    if wanted is None:
        whole = isinstance(fixed[0], int) and isinstance(fixed[1], int)
        return name, _DTYPES[value.type], fixed if whole else None
    for side, asked in zip(fixed, wanted, strict=True):
        if isinstance(side, int) and side != asked:
            raise InputError(
                f"{sidecar.path}: input size {wanted[0]}x{wanted[1]}, "
                f"but {model.name} takes {fixed[0]}x{fixed[1]}"
            )
    return name, _DTYPES[value.type], wanted


def _outputs_of(session: Any, sidecar: Sidecar) -> dict[str, str]:
    """Output names by part, all of which the model has."""
    names = [value.name for value in session.get_outputs()]
    if not names:
        raise InputError(f"{sidecar.path}: the model gives no output")
    for part, name in sidecar.output.tensors.items():
        if name not in names:
            raise InputError(
                f"{sidecar.path}: output {shown(name)} ({part}) is not of the model, "
                f"which has {_listed(names)}"
            )
    return dict(sidecar.output.tensors)


def _listed(names: Iterable[str]) -> str:
    return shortened(", ".join(names), 200)


def _first_line(error: Exception) -> str:
    return shortened((str(error).strip().splitlines() or [type(error).__name__])[0], 300)
