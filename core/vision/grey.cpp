#include "core/vision/grey.h"

#include "core/base/check.h"

namespace vsgraphs {

void to_grey(const ImageView<Rgb>& colour, Image<std::uint8_t>& out) {
  require_input(!colour.empty(), "to_grey: the colour image is empty; give an image with pixels");
  out.width = colour.width;
  out.height = colour.height;
  out.pixels.resize(static_cast<std::size_t>(colour.width) * colour.height);
  const int width = colour.width;
  for (int v = 0; v < colour.height; ++v) {
    const Rgb* __restrict in = colour.row(v);
    std::uint8_t* __restrict to = &out.at(0, v);
    for (int u = 0; u < width; ++u) {
      to[u] = static_cast<std::uint8_t>(
          static_cast<std::uint16_t>(77 * in[u].r + 150 * in[u].g + 29 * in[u].b + 128) >> 8);
    }
  }
}

Image<std::uint8_t> to_grey(const ImageView<Rgb>& colour) {
  Image<std::uint8_t> out;
  to_grey(colour, out);
  return out;
}

}  // namespace vsgraphs
