#include "core/simulate/texture.h"

#include <algorithm>
#include <bit>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

// Averages 2x2 texels (2x1 where one side is down to a single texel).
Image<Rgb> halve(const Image<Rgb>& in) {
  Image<Rgb> out(std::max(1, in.width / 2), std::max(1, in.height / 2));
  const int sx = in.width / out.width, sy = in.height / out.height;
  for (int v = 0; v < out.height; ++v) {
    for (int u = 0; u < out.width; ++u) {
      int sum[3] = {0, 0, 0};
      for (int dy = 0; dy < sy; ++dy) {
        for (int dx = 0; dx < sx; ++dx) {
          const Rgb c = in.at(u * sx + dx, v * sy + dy);
          sum[0] += c.r, sum[1] += c.g, sum[2] += c.b;
        }
      }
      const int n = sx * sy;
      const auto mean = [n](int x) { return static_cast<std::uint8_t>((x + n / 2) / n); };
      out.at(u, v) = {mean(sum[0]), mean(sum[1]), mean(sum[2])};
    }
  }
  return out;
}

}  // namespace

Texture::Level Texture::pack(const Image<Rgb>& image) {
  Level level{image.width, image.height, std::countr_zero(static_cast<unsigned>(image.width)), {}};
  level.texels.reserve(image.pixels.size());
  for (const Rgb c : image.pixels)
    level.texels.push_back(c.r | static_cast<std::uint32_t>(c.g) << 8 |
                           static_cast<std::uint32_t>(c.b) << 16);
  return level;
}

Texture::Texture(const Image<Rgb>& base) {
  VSG_INVARIANT(base.width > 0 && std::has_single_bit(static_cast<unsigned>(base.width)));
  VSG_INVARIANT(base.height > 0 && std::has_single_bit(static_cast<unsigned>(base.height)));
  Image<Rgb> image = base;
  levels_.push_back(pack(image));
  while (image.width > 1 || image.height > 1) {
    image = halve(image);
    levels_.push_back(pack(image));
  }
}

}  // namespace vsgraphs
