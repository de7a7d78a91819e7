"""A network's output tensors -> a Segmentation, for each kind a sidecar may name."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from vsgraphs.errors import InputError
from vsgraphs.segment.roles import SurfaceRole
from vsgraphs.segment.segmentation import Segmentation

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vsgraphs.segment.sidecar import Sidecar

_Tensor = npt.NDArray[Any]
_MASK_THRESHOLD = 0.5  # a pixel belongs to a mask it is more likely in than not
_NO_SEGMENT = np.iinfo(np.uint16).max


def interpret(tensors: Mapping[str, _Tensor], sidecar: Sidecar) -> Segmentation:
    """tensors: by part as the sidecar names them. Raises InputError where shapes do not fit the kind."""
    return _KINDS[sidecar.output.kind](tensors, sidecar)


def _semantic(tensors: Mapping[str, _Tensor], sidecar: Sidecar) -> Segmentation:
    """Scores per class and pixel: the best class, and its probability as confidence."""
    scores = _without_batch(tensors["scores"], 4, "scores", sidecar)
    if sidecar.output.layout == "NHWC":
        scores = np.moveaxis(scores, 2, 0)
    sidecar.roles.check_count(len(scores))
    scores = np.asarray(scores, np.float32)
    classes = scores.argmax(axis=0)
    best = np.take_along_axis(scores, classes[None], axis=0)[0]
    if sidecar.output.values == "logits":
        best = 1 / np.exp(scores - best).sum(axis=0)  # softmax of the largest
    return Segmentation(sidecar.roles.roles(classes), np.clip(best, 0, 1), None, *sidecar.named(classes))


def _semantic_argmax(tensors: Mapping[str, _Tensor], sidecar: Sidecar) -> Segmentation:
    classes = _plane(tensors["classes"], "classes", sidecar)
    return Segmentation(sidecar.roles.roles(classes), None, None, *sidecar.named(classes))


def _panoptic_masks(tensors: Mapping[str, _Tensor], sidecar: Sidecar) -> Segmentation:
    """Queries with a class and a mask each, put together by the general inference of Cheng et al.,
    "Per-Pixel Classification is Not All You Need for Semantic Segmentation" (2021), section 3.4, as
    "Masked-attention Mask Transformer" (2022) and YOSO (Hu et al. 2023) use it.

    A query counts when its best class is not void and likelier than score_threshold; a pixel goes to the
    query with the largest class probability x mask probability; a query that keeps less than
    overlap_threshold of its mask to itself is dropped. Queries of one class stay apart: each is an instance.
    """
    output = sidecar.output
    class_logits = _without_batch(tensors["class_logits"], 3, "class_logits", sidecar)
    mask_logits = _without_batch(tensors["mask_logits"], 4, "mask_logits", sidecar)
    if len(class_logits) != len(mask_logits):
        raise InputError(
            f"{sidecar.path}: class_logits has {len(class_logits)} queries, mask_logits {len(mask_logits)}"
        )
    void = class_logits.shape[1] - 1 if output.void_class is None else output.void_class
    if void >= class_logits.shape[1]:
        raise InputError(f"{sidecar.path}: void_class is {void}, the network gives {class_logits.shape[1]}")
    last = void == class_logits.shape[1] - 1
    sidecar.roles.check_count(class_logits.shape[1] - (1 if last else 0))
    probabilities = _softmax(np.asarray(class_logits, np.float32))
    classes = probabilities.argmax(axis=1)
    scores = probabilities.max(axis=1)
    kept = np.flatnonzero((classes != void) & (scores > output.score_threshold))
    shape = mask_logits.shape[1:]
    instances = np.zeros(shape, np.uint16)
    confidence = np.zeros(shape, np.float32)
    roles = np.zeros(shape, np.uint8)
    class_of, names = sidecar.named(classes[kept])
    named = None if class_of is None else np.zeros(shape, np.uint16)
    if not len(kept):
        return Segmentation(roles, confidence, instances, named, names)
    masks = _sigmoid(np.asarray(mask_logits[kept], np.float32))
    weighted = masks * scores[kept, None, None]
    owner = weighted.argmax(axis=0)
    role_of = sidecar.roles.roles(classes[kept])
    for k in range(len(kept)):
        mask = masks[k] >= _MASK_THRESHOLD
        mine = owner == k
        if not mask.any() or np.count_nonzero(mine) < output.overlap_threshold * np.count_nonzero(mask):
            continue
        mine &= mask
        instances[mine] = k + 1
        confidence[mine] = weighted[k][mine]
        roles[mine] = role_of[k]
        if named is not None and class_of is not None:
            named[mine] = class_of[k]
    return Segmentation(roles, confidence, instances, named, names)


def _panoptic_segments(tensors: Mapping[str, _Tensor], sidecar: Sidecar) -> Segmentation:
    """A map of segment numbers with the class (and score) of each segment: what Detectron2's panoptic models
    (Panoptic-FCN, YOSO's own post-processing) end with.
    """
    segments = _plane(tensors["segments"], "segments", sidecar).astype(np.int64)
    classes = tensors["segment_classes"].reshape(-1)
    numbers = np.arange(1, len(classes) + 1)
    if "segment_ids" in tensors:
        numbers = tensors["segment_ids"].reshape(-1).astype(np.int64)
    scores = np.ones(len(classes), np.float32)
    if "segment_scores" in tensors:
        scores = np.clip(tensors["segment_scores"].reshape(-1).astype(np.float32), 0, 1)
    if not len(classes) == len(numbers) == len(scores):
        raise InputError(
            f"{sidecar.path}: {len(classes)} segment classes, {len(numbers)} ids, {len(scores)} scores"
        )
    if numbers.size and not (numbers.min() >= 0 and numbers.max() < _NO_SEGMENT):
        raise InputError(f"{sidecar.path}: segment ids must be 0 to {_NO_SEGMENT - 1}")
    if segments.max() > _NO_SEGMENT:
        raise InputError(f"{sidecar.path}: segment {segments.max()} in the image has no class")
    row = np.full(int(max(segments.max(), numbers.max(initial=0), sidecar.output.void_segment)) + 1, -1)
    row[numbers] = np.arange(len(numbers))
    row[sidecar.output.void_segment] = len(numbers)
    if segments.min() < 0 or (row[segments] < 0).any():
        stray = segments[(segments < 0) | (row[np.maximum(segments, 0)] < 0)].flat[0]
        raise InputError(f"{sidecar.path}: segment {stray} in the image has no class")
    found = row[segments]
    roles = np.append(sidecar.roles.roles(classes), np.uint8(SurfaceRole.undecided))
    void = found == len(numbers)
    instances = np.where(void, 0, segments).astype(np.uint16)
    class_of, names = sidecar.named(classes)
    named = None if class_of is None else np.append(class_of, np.uint16(0))[found]
    return Segmentation(roles[found], np.append(scores, np.float32(0))[found], instances, named, names)


_KINDS = {
    "semantic": _semantic,
    "semantic_argmax": _semantic_argmax,
    "panoptic_masks": _panoptic_masks,
    "panoptic_segments": _panoptic_segments,
}


def _without_batch(tensor: _Tensor, dimensions: int, what: str, sidecar: Sidecar) -> _Tensor:
    if tensor.ndim == dimensions and tensor.shape[0] == 1:
        tensor = tensor[0]
    if tensor.ndim != dimensions - 1 or not tensor.size:
        kind = sidecar.output.kind
        raise InputError(
            f"{sidecar.path}: output '{what}' of kind {kind} has shape {tensor.shape}, "
            f"expected {_SHAPES[what]}"
        )
    return tensor


def _plane(tensor: _Tensor, what: str, sidecar: Sidecar) -> _Tensor:
    """(1, h, w), (1, 1, h, w), (1, h, w, 1) or (h, w) -> (h, w)."""
    shape = tensor.shape
    for axis in (-1, 0, 0):  # the channel may come last, the batch first; (1, 1, h, w) has both in front
        if tensor.ndim > 2 and tensor.shape[axis] == 1:
            tensor = tensor.squeeze(axis)
    if tensor.ndim != 2 or not tensor.size:
        raise InputError(f"{sidecar.path}: output '{what}' has shape {shape}, expected (1, h, w)")
    if not np.issubdtype(tensor.dtype, np.integer):
        raise InputError(f"{sidecar.path}: output '{what}' is {tensor.dtype}, expected integers")
    return tensor


_SHAPES = {
    "scores": "(1, classes, h, w), or (1, h, w, classes) with layout NHWC",
    "class_logits": "(1, queries, classes + 1)",
    "mask_logits": "(1, queries, h, w)",
}


def _softmax(logits: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    powers = np.exp(logits - logits.max(axis=-1, keepdims=True))
    normalised: npt.NDArray[np.float32] = powers / powers.sum(axis=-1, keepdims=True)
    return normalised


def _sigmoid(logits: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    half: npt.NDArray[np.float32] = 0.5 * (1 + np.tanh(0.5 * logits))  # does not overflow
    return half
