// What the markers of the ArUco dictionary 4x4_50 look like: 16 bits each, row by row from the upper left, the first in the
// highest place; 1 is white. A frame of black cells surrounds them. Read off cv2.aruco.generateImageMarker (OpenCV 5.0.0,
// Apache-2.0); the dictionary is that of Garrido-Jurado, Munoz-Salinas, Madrid-Cuevas and Marin-Jimenez, "Automatic
// generation and detection of highly reliable fiducial markers under occlusion", Pattern Recognition 2014.
#pragma once

#include <array>
#include <cstdint>

namespace vsgraphs {

inline constexpr std::array<std::uint16_t, 50> marker_bits = {
    0xb532, 0x0f9a, 0x332d, 0x9946, 0x549e, 0x79cd, 0x9e2e, 0xc4f2, 0xfeda, 0xcf56, 0xf991, 0x11a7, 0x0eb7,
    0x2a0f, 0x24b1, 0x263e, 0x4665, 0x6600, 0x6c5e, 0x76af, 0x868b, 0xb02b, 0xccd5, 0xdd82, 0xfe47, 0x9471,
    0xace4, 0xa554, 0x2123, 0x346f, 0x4415, 0x57b2, 0x9ecf, 0xf0cb, 0x08ae, 0x0929, 0x1875, 0x04ff, 0x0df6,
    0x1c5a, 0x1718, 0x2a28, 0x328c, 0x38b2, 0x24e8, 0x2eeb, 0x2d3f, 0x4b64, 0x502e, 0x5013,
};
inline constexpr int marker_cells = 6;  // along a side, the black frame included

}  // namespace vsgraphs
