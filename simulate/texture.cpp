#include "simulate/texture.h"

#include <algorithm>
#include <bit>
#include <cstring>

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
  Level level{image.width, image.height, {}};
  level.texels.reserve(static_cast<std::size_t>(level.stride()) * image.height);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u <= image.width; ++u) {
      const Rgb c = image.at(u % image.width, v);
      level.texels.push_back(c.r | static_cast<std::uint32_t>(c.g) << 8 |
                             static_cast<std::uint32_t>(c.b) << 16);
    }
  }
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

void Texture::sample_batch(const float* s, const float* t, int level, Batch& out) const {
  const Level& l = levels_[static_cast<std::size_t>(level)];
  const float w = static_cast<float>(l.width * 256), h = static_cast<float>(l.height * 256);
  std::int32_t x[batch], y[batch];
  for (int i = 0; i < batch; ++i) {
    const float u = s[i] - static_cast<float>(static_cast<int>(s[i]) - (s[i] < 0));
    const float v = t[i] - static_cast<float>(static_cast<int>(t[i]) - (t[i] < 0));
    x[i] = static_cast<std::int32_t>(u * w) - 128;
    y[i] = static_cast<std::int32_t>((1.0f - v) * h) - 128;
  }
  std::uint32_t corner[4][batch];
  const std::uint32_t* texels = l.texels.data();
  const int right = l.width - 1, last = l.height - 1, stride = l.stride();
  for (int i = 0; i < batch; ++i) {
    const int x0 = (x[i] >> 8) & right;
    const std::uint32_t *upper = texels + ((y[i] >> 8) & last) * stride + x0,
                        *lower = texels + (((y[i] >> 8) + 1) & last) * stride + x0;
    std::uint64_t pair[2];  // two neighbours at once
    std::memcpy(&pair[0], upper, 8), std::memcpy(&pair[1], lower, 8);
    constexpr bool little = std::endian::native == std::endian::little;
    for (int k = 0; k < 2; ++k) {
      const auto low = static_cast<std::uint32_t>(pair[k]), high = static_cast<std::uint32_t>(pair[k] >> 32);
      corner[2 * k][i] = little ? low : high, corner[2 * k + 1][i] = little ? high : low;
    }
  }
  constexpr std::uint32_t rb = 0x00ff00ff, g = 0x0000ff00;
  for (int i = 0; i < batch; ++i) {
    const auto fx = static_cast<std::uint32_t>(x[i] & 255), fy = static_cast<std::uint32_t>(y[i] & 255);
    const auto mix = [](std::uint32_t a, std::uint32_t b, std::uint32_t f) { return a * (256 - f) + b * f; };
    const std::uint32_t rb0 = (mix(corner[0][i] & rb, corner[1][i] & rb, fx) >> 8) & rb;
    const std::uint32_t rb1 = (mix(corner[2][i] & rb, corner[3][i] & rb, fx) >> 8) & rb;
    const std::uint32_t g0 = mix((corner[0][i] & g) >> 8, (corner[1][i] & g) >> 8, fx);
    const std::uint32_t g1 = mix((corner[2][i] & g) >> 8, (corner[3][i] & g) >> 8, fx);
    const std::uint32_t rb2 = mix(rb0, rb1, fy);
    // Below 2^31: as signed numbers they are converted by one instruction.
    out.r[i] = static_cast<float>(static_cast<std::int32_t>(rb2 & 0xffff)) * (1.0f / 256);
    out.g[i] = static_cast<float>(static_cast<std::int32_t>(mix(g0, g1, fy))) * (1.0f / 65536);
    out.b[i] = static_cast<float>(static_cast<std::int32_t>(rb2 >> 16)) * (1.0f / 256);
  }
}

}  // namespace vsgraphs
