"""Tracks a camera through a recorded sequence: `python examples/track_folder.py FOLDER`."""

import sys

import vsgraphs


def main(folder: str) -> None:
    """Tells each keyframe, and where the camera ended."""
    sequence = vsgraphs.open_sequence(folder)
    slam = vsgraphs.Slam(vsgraphs.Config(), sequence.camera)
    for frame in sequence.frames:
        rgb, depth = frame.load()  # (H, W, 3) uint8, (H, W) uint16 raw units
        result = slam.track(rgb, depth, frame.timestamp)
        if result.is_keyframe:
            print(f"{frame.timestamp:.3f} s: keyframe, {result.status}, {result.matches} matches")
    slam.finish()
    timestamps, poses = slam.trajectory()  # (N,) seconds, (N, 4, 4) world_from_camera, metres
    print(f"{len(timestamps)} of {len(sequence.frames)} frames tracked")
    print(f"the path ends at {poses[-1, :3, 3].round(3)}")


if __name__ == "__main__":
    main(sys.argv[1])
