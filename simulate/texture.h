// Images on surfaces: power-of-two sides, repeated in both directions, with a pyramid of box-filtered levels so that
// distant surfaces do not flicker (Williams, "Pyramidal parametrics", 1983).
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace vsgraphs {

struct Colour {  // linear working space, 255 = white under the room's nominal light; may exceed it
  float r = 0, g = 0, b = 0;
};

class Texture {
 public:
  // Takes the finest level; its sides must be powers of two (InvariantError otherwise).
  explicit Texture(const Image<Rgb>& base);

  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }
  int level_count() const { return static_cast<int>(levels_.size()); }

  // Bilinear at one level; (s, t) in repeats, t upwards (t = 0 is the image's lower edge). Level 0 is the finest.
  Colour sample(float s, float t, int level) const;
  // The same at eight places at once, in steps that compilers turn into vector instructions: the same bytes, in half
  // the time.
  static constexpr int batch = 8;
  struct Batch {
    float r[batch], g[batch], b[batch];
  };
  void sample_batch(const float* s, const float* t, int level, Batch& out) const;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint32_t> texels;  // r | g << 8 | b << 16; each row's first once more behind its last
    int stride() const { return width + 1; }
  };
  static Level pack(const Image<Rgb>& image);
  std::vector<Level> levels_;
};

inline Colour Texture::sample(float s, float t, int level) const {
  const Level& l = levels_[static_cast<std::size_t>(level)];
  // 8 fraction bits are enough for 8-bit texels and keep the blend in integers.
  const auto fixed = [](float x, int size) {
    return static_cast<std::int32_t>(x * static_cast<float>(size * 256)) - 128;
  };
  s -= static_cast<float>(static_cast<int>(s) - (s < 0));
  t -= static_cast<float>(static_cast<int>(t) - (t < 0));
  const std::int32_t x = fixed(s, l.width), y = fixed(1.0f - t, l.height);
  const int x0 = (x >> 8) & (l.width - 1), x1 = x0 + 1;
  const int y0 = (y >> 8) & (l.height - 1), y1 = (y0 + 1) & (l.height - 1);
  const std::uint32_t fx = x & 255, fy = y & 255;
  const std::uint32_t* row0 = l.texels.data() + static_cast<std::ptrdiff_t>(y0) * l.stride();
  const std::uint32_t* row1 = l.texels.data() + static_cast<std::ptrdiff_t>(y1) * l.stride();
  // Two channels at a time: r and b share one word, g has its own.
  const auto mix = [](std::uint32_t a, std::uint32_t b, std::uint32_t f) { return a * (256 - f) + b * f; };
  constexpr std::uint32_t rb = 0x00ff00ff, g = 0x0000ff00;
  const std::uint32_t rb0 = (mix(row0[x0] & rb, row0[x1] & rb, fx) >> 8) & rb;
  const std::uint32_t rb1 = (mix(row1[x0] & rb, row1[x1] & rb, fx) >> 8) & rb;
  const std::uint32_t g0 = mix((row0[x0] & g) >> 8, (row0[x1] & g) >> 8, fx);
  const std::uint32_t g1 = mix((row1[x0] & g) >> 8, (row1[x1] & g) >> 8, fx);
  const std::uint32_t rb2 = mix(rb0, rb1, fy);
  return {static_cast<float>(rb2 & 0xffff) * (1.0f / 256),
          static_cast<float>(mix(g0, g1, fy)) * (1.0f / 65536), static_cast<float>(rb2 >> 16) * (1.0f / 256)};
}

}  // namespace vsgraphs
