#!/usr/bin/env python3
"""Does a second session end in the first one's frame? Maps one sequence, then another of the place.

    benchmarks/multi_session.py DATA/three_rooms_1 DATA/three_rooms_2
    benchmarks/multi_session.py DATA/three_rooms_1 DATA/three_rooms_2 --max-frames 700 --skip 900  # elsewhere

The second one starts from the atlas file of the first. Both need their truth in one frame, as draws or parts
of one plan have. Serial. Errors are RMSE after the alignment of the first session's trajectory with the truth
(SE3, no scale), of the second session too: so its error holds whatever the two frames differ by. In brackets
the second one's when aligned for itself.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from relocalisation import aligned, rmse_mm, true_positions

import vsgraphs
from vsgraphs.run.settings import apply_assignments
from vsgraphs.trajectory import read_tum_trajectory


class Session:
    """One sequence, mapped, and where the camera truly was."""

    def __init__(self, folder: Path, config: vsgraphs.Config, atlas: Any, skip: int, max_frames: int | None):
        sequence = vsgraphs.open_sequence(folder)
        known = (atlas.state,) if atlas else ()
        self.config, self.camera = config, sequence.camera
        self.slam = vsgraphs.Slam(config, sequence.camera, *known)
        self.lost = 0
        for frame in sequence.frames[skip:][:max_frames]:
            rgb, depth = frame.load()
            self.lost += not self.slam.track(rgb, depth, frame.timestamp).tracked
        self.slam.finish()
        stamps, poses = self.slam.trajectory()
        truth = read_tum_trajectory(folder / "groundtruth.txt")
        within, self.true = true_positions(truth, stamps)
        self.positions = poses[within, :3, 3]

    def save(self, file: Path) -> None:
        """All of its maps."""
        vsgraphs.Atlas(self.slam.atlas_state(), self.config, self.camera).save(file)

    def alignment(self) -> tuple[np.ndarray, np.ndarray]:
        """From the map's frame to the truth's."""
        return aligned(self.positions, self.true)

    def ate_mm(self, alignment: tuple[np.ndarray, np.ndarray]) -> float:
        """RMSE of all positions."""
        return rmse_mm(self.positions, self.true, alignment)

    def counts(self) -> str:
        """What the map holds."""
        graph = self.slam.snapshot().scene_graph()
        statistics = self.slam.statistics()
        walls = sum(plane["role"] == "wall" for plane in graph["planes"])
        return (
            f"{statistics['maps']} map(s), {len(self.slam.snapshot().keyframes()[0])} keyframes, "
            f"{walls} wall surfaces, {len(graph['rooms'])} rooms, {self.lost} frames without pose"
        )


def main() -> None:
    """Prints one line per session."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("first", type=Path)
    parser.add_argument("second", type=Path)
    parser.add_argument("--skip", type=int, default=0, help="of the second one, so many frames")
    parser.add_argument("--max-frames", type=int, help="of the first one, so many frames")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="an option")
    options = parser.parse_args()
    config = vsgraphs.Config()
    config.set("system.execution", "serial")
    apply_assignments(config, options.set)
    first = Session(options.first, config, None, 0, options.max_frames)
    alignment = first.alignment()
    print(f"first: {first.ate_mm(alignment):.1f} mm; {first.counts()}", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "atlas.vsg"
        first.save(file)
        second = Session(options.second, config, vsgraphs.load_atlas(file), options.skip, None)
    own = second.ate_mm(second.alignment())
    print(f"second: {second.ate_mm(alignment):.1f} mm (for itself {own:.1f} mm); {second.counts()}")


if __name__ == "__main__":
    main()
