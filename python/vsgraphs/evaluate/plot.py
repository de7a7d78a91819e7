"""A picture of both trajectories: from above and from the side, the estimate coloured by its error."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from vsgraphs.evaluate.evaluation import Evaluation
    from vsgraphs.trajectory import Array

_AXES = "xyz"


def draw(evaluation: Evaluation, kind: str) -> bytes:
    """The picture as bytes of `kind` ("png" or "svg"). Equal input gives equal bytes."""
    import matplotlib as mpl

    mpl.use("agg")
    mpl.rcParams["svg.hashsalt"] = "vsgraphs"
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12, 6.2), layout="constrained")
    up, sign = up_axis(evaluation.truth)
    first, second = horizontal_axes(evaluation.truth[:, :3, 3], up)
    panels: Any = figure.subplots(1, 2)
    views = (
        ("from above", (first, 1.0), (second, _handedness(first, second, up) * sign)),
        ("from the side", (first, 1.0), (up, sign)),
    )
    lines: Any = None
    for panel, (title, across, along) in zip(panels, views, strict=True):
        lines = _panel(panel, evaluation, across, along)
        panel.set_title(title)
    panels[0].legend(loc="best", fontsize="small")
    bar = figure.colorbar(lines, ax=panels, shrink=0.8, pad=0.02)
    bar.set_label("distance from the truth, m")
    ate = evaluation.ate
    figure.suptitle(
        f"ATE {ate.rmse:.4f} m RMSE, {ate.median:.4f} median, {ate.max:.4f} max; "
        f"{evaluation.pairs} poses, {evaluation.path_m:.1f} m"
    )
    out = io.BytesIO()
    metadata = {"Software": None} if kind == "png" else {"Date": None, "Creator": None}
    figure.savefig(out, format=kind, dpi=110, metadata=metadata)
    return out.getvalue()


def up_axis(poses: Array) -> tuple[int, float]:
    """Which world axis is up, and its sign: the one closest to what cameras on average call up (-y).

    Cameras are held upright more often than not; a trajectory file does not say which way is up.
    """
    mean_up = -poses[:, :3, 1].mean(axis=0)
    axis = int(np.argmax(np.abs(mean_up)))
    return axis, float(np.sign(mean_up[axis]) or 1.0)


def horizontal_axes(positions: Array, up: int) -> tuple[int, int]:
    """The two other axes, the one with the longer extent first: pictures are wide."""
    extent = np.ptp(positions, axis=0)
    first, second = sorted((axis for axis in range(3) if axis != up), key=lambda axis: -extent[axis])
    return first, second


def _handedness(first: int, second: int, up: int) -> float:
    """1 where first, second, up are a right-handed triple: then second points up on the page seen from
    above.
    """
    return 1.0 if (first, second, up) in ((0, 1, 2), (1, 2, 0), (2, 0, 1)) else -1.0


def _panel(panel: Any, evaluation: Evaluation, across: tuple[int, float], along: tuple[int, float]) -> Any:
    from matplotlib.collections import LineCollection

    def flat(poses: Array) -> Array:
        points: Array = np.stack([sign * poses[:, axis, 3] for axis, sign in (across, along)], axis=1)
        return points

    truth, estimate = flat(evaluation.truth), flat(evaluation.aligned)
    panel.plot(truth[:, 0], truth[:, 1], color="0.55", linewidth=1.2, linestyle="--", label="truth", zorder=1)
    segments = np.stack([estimate[:-1], estimate[1:]], axis=1)
    lines = LineCollection(list(segments), cmap="viridis", linewidths=1.8, label="estimate", zorder=2)
    lines.set_array((evaluation.errors_m[:-1] + evaluation.errors_m[1:]) / 2)
    lines.set_clim(0.0, max(float(evaluation.errors_m.max()), 1e-9))
    panel.add_collection(lines)
    panel.plot(*truth[0], "o", color="black", fillstyle="none", markersize=9, label="start", zorder=3)
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_xlabel(_label(across))
    panel.set_ylabel(_label(along))
    panel.grid(visible=True, linewidth=0.4, alpha=0.5)
    panel.margins(0.06)
    panel.autoscale_view()
    return lines


def _label(axis: tuple[int, float]) -> str:
    return f"{'-' if axis[1] < 0 else ''}{_AXES[axis[0]]}, m"
