"""Any Python function as the segmenter: `python examples/segmenter_callable.py FOLDER`.

The rule below stands where a network would. With torch, for example, a segmenter is five lines:

    def segment(rgb):
        with torch.inference_mode():
            scores = model(normalise(torch.from_numpy(rgb)))[0]      # (classes, h, w)
        confidence, classes = scores.softmax(0).max(0)
        return Segmentation(ROLE_OF_CLASS[classes.numpy()], confidence.numpy())
"""

import sys

import numpy as np
import numpy.typing as npt

import vsgraphs
from vsgraphs.segment import Segmentation, SurfaceRole, attach


def segment(rgb: npt.NDArray[np.uint8]) -> Segmentation:
    """For a camera held level: wall above, ground in the lowest quarter, the surer the further down.

    One value for each 8 x 8 pixels: a segmentation may be coarser than its image.
    """
    rows, columns = rgb.shape[0] // 8, rgb.shape[1] // 8
    roles = np.full((rows, columns), SurfaceRole.wall, np.uint8)
    roles[3 * rows // 4 :] = SurfaceRole.ground
    confidence = np.full((rows, columns), 0.5, np.float32)
    confidence[3 * rows // 4 :] = np.linspace(0.5, 1, rows - 3 * rows // 4)[:, None]
    return Segmentation(roles, confidence)


def main(folder: str) -> None:
    """Tracks a recorded sequence; its keyframes are segmented beside tracking."""
    sequence = vsgraphs.open_sequence(folder)
    slam = vsgraphs.Slam(vsgraphs.Config(), sequence.camera)
    with attach(slam, segment) as tracked:  # takes the place of slam for track()
        for frame in sequence.frames:
            rgb, depth = frame.load()
            tracked.track(rgb, depth, frame.timestamp)
    slam.finish()
    counts = tracked.report()
    print(
        f"{counts['segmented']} keyframes segmented, {counts['dropped']} dropped, {counts['failed']} failed"
    )


if __name__ == "__main__":
    main(sys.argv[1])
