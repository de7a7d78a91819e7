// Colour to grey.
#pragma once

#include <cstdint>

#include "core/base/image.h"

namespace vsgraphs {

// Luma of ITU-R BT.601 (0.299 R + 0.587 G + 0.114 B) in 8-bit fixed point, so that every machine gives the
// same bytes. `out` is resized as needed and reused between calls. Throws InputError on an empty image.
void to_grey(const ImageView<Rgb>& colour, Image<std::uint8_t>& out);
Image<std::uint8_t> to_grey(const ImageView<Rgb>& colour);

}  // namespace vsgraphs
