"""Which pixels are wall, ground, ceiling, door or window: segmenters and how they run beside tracking.

    from vsgraphs.segment import Segmentation, SurfaceRole, attach

    def my_model(rgb):                                    # (H, W, 3) uint8
        roles = ...                                       # (h, w) uint8 of SurfaceRole
        return Segmentation(roles)

    with attach(slam, my_model) as tracked:               # instead of slam.track
        tracked.track(rgb, depth, timestamp)

See docs/segmentation.md.
"""

from vsgraphs.segment.choose import make_segmenter
from vsgraphs.segment.keyframes import KeyframeSegmentation, attach
from vsgraphs.segment.roles import SurfaceRole, role_of_class
from vsgraphs.segment.segmentation import RecordedSegmentations, Segmentation, Segmenter, name_of

__all__ = [
    "KeyframeSegmentation",
    "RecordedSegmentations",
    "Segmentation",
    "Segmenter",
    "SurfaceRole",
    "attach",
    "make_segmenter",
    "name_of",
    "role_of_class",
]
