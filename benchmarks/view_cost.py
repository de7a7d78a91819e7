"""What viewing costs tracking: time per frame of the tracker's caller, with and without a view, run by run.

    benchmarks/view_cost.py SEQUENCE [--frames 300] [--runs 3] [--fps 30]

The view records to a file. Frames are decoded before and fed at camera pace; a frame's time is that of
track() and of handing it over, with every wait for the interpreter, which the view's thread shares.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

import vsgraphs
from vsgraphs.datasets import RecordedSequence
from vsgraphs.view import LiveView, SinkRequest, open_sinks


def one_run(
    sequence: RecordedSequence, frames: list[Any], period_s: float, record: Path | None
) -> dict[str, Any]:
    """Times in ms of every frame of one run, and what the view says."""
    slam = vsgraphs.Slam(vsgraphs.Config(), sequence.camera)
    tracker: Any = slam
    view = None
    if record is not None:
        sinks = open_sinks(SinkRequest(record=record), print)
        view = LiveView(slam, sequence.calibration, sinks, with_planes=True, tell=print)
        tracker = view.watch(slam)
    times = []
    due = time.monotonic()
    for rgb, depth, timestamp in frames:
        time.sleep(max(0.0, due - time.monotonic()))
        began = time.perf_counter()
        tracker.track(rgb, depth, timestamp)
        times.append(1000 * (time.perf_counter() - began))
        due += period_s
    slam.finish()
    if view is not None:
        view.close()
    return {"times_ms": times, "view": view.report() if view is not None else None}


def main() -> None:
    """Measures and prints a line for each kind of run, then the difference."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("sequence", type=Path)
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--fps", type=float, default=30.0)
    options = parser.parse_args()
    sequence = vsgraphs.open_sequence(options.sequence)
    frames = [(*frame.load(), frame.timestamp) for frame in sequence.frames[: options.frames]]
    means: dict[str, list[float]] = {"without": [], "with": []}
    for _ in range(options.runs):
        for name, mean in means.items():
            with tempfile.TemporaryDirectory() as folder:
                record = Path(folder) / "view.rrd" if name == "with" else None
                run = one_run(sequence, frames, 1 / options.fps, record)
            times = np.array(run["times_ms"])
            mean.append(float(times.mean()))
            print(
                f"{name:8} mean {times.mean():.2f} ms, median {np.median(times):.2f}, "
                f"p95 {np.percentile(times, 95):.2f}"
                f"  {json.dumps(run['view']) if run['view'] else ''}",
                flush=True,
            )
    extra = np.array(means["with"]) - np.array(means["without"])
    print(
        f"viewing adds {np.median(extra):.2f} ms per frame (median over runs; {np.round(extra, 2).tolist()})"
    )


if __name__ == "__main__":
    main()
