// Brightness and noise of the colour image.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/check.h"
#include "core/base/rng.h"
#include "simulate/sensor_noise.h"

namespace vsgraphs {
namespace {

// Share of the noise that hits all channels alike; what is left differs from channel to channel.
constexpr float common_share = 0.9f, own_share = 0.44f;
constexpr std::size_t table_size = 16384;

// Normal numbers by the hundred thousand would cost more than the rendering: a table is read from random places.
class NoiseTable {
 public:
  NoiseTable(Rng& rng, double sigma) : values_(table_size) {
    for (float& x : values_) x = static_cast<float>(sigma * rng.normal());
  }
  // `count` numbers from a random place; count at most table_size.
  const float* stretch(Rng& rng, std::size_t count) const {
    return values_.data() + rng.index(static_cast<std::uint32_t>(table_size - count + 1));
  }

 private:
  std::vector<float> values_;
};

// Rows of light blurred by optics and colour mosaic: five weights across and down, of a Gaussian.
class Optics5 {
 public:
  Optics5(double sigma_px, const std::vector<float>& light, int width, int height)
      : light_(light), width_(static_cast<std::size_t>(width)), height_(height), mixed_(3 * width_ + 4) {
    if (sigma_px <= 0) return;
    double sum = 0;
    for (int k = -2; k <= 2; ++k) sum += std::exp(-0.5 * k * k / (sigma_px * sigma_px));
    for (int k = 0; k <= 2; ++k)
      weights_[static_cast<std::size_t>(k)] =
          static_cast<float>(std::exp(-0.5 * k * k / (sigma_px * sigma_px)) / sum);
  }

  // The three channels of each pixel side by side, times `scale`, plus a half.
  void row(int v, float scale, std::vector<float>& out) {
    const float* in = at(v);
    if (weights_[0] >= 1) {
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t u = 0; u < width_; ++u) out[3 * u + k] = scale * in[k * width_ + u] + 0.5f;
      return;
    }
    const float *a = at(v - 2), *b = at(v - 1), *c = at(v + 1), *d = at(v + 2);
    const float w0 = scale * weights_[0], w1 = scale * weights_[1], w2 = scale * weights_[2];
    float* mixed = mixed_.data() + 2;
    for (std::size_t i = 0; i < 3 * width_; ++i)
      mixed[i] = w0 * in[i] + w1 * (b[i] + c[i]) + w2 * (a[i] + d[i]);
    for (std::size_t k = 0; k < 3; ++k) across(mixed + k * width_, k, out);
  }

 private:
  const float* at(int v) const {
    return light_.data() + 3 * width_ * static_cast<std::size_t>(std::clamp(v, 0, height_ - 1));
  }
  void across(const float* in, std::size_t k, std::vector<float>& out) const {
    const auto last = static_cast<std::ptrdiff_t>(width_) - 1;
    const auto blurred = [&](std::ptrdiff_t u, std::ptrdiff_t l2, std::ptrdiff_t l1, std::ptrdiff_t r1,
                             std::ptrdiff_t r2) {
      out[3 * static_cast<std::size_t>(u) + k] =
          weights_[0] * in[u] + weights_[1] * (in[l1] + in[r1]) + weights_[2] * (in[l2] + in[r2]) + 0.5f;
    };
    for (std::ptrdiff_t u = 2; u < last - 1; ++u) blurred(u, u - 2, u - 1, u + 1, u + 2);
    for (std::ptrdiff_t u = 0; u <= last; u = u == 1 ? std::max<std::ptrdiff_t>(2, last - 1) : u + 1) {
      const auto inside = [&](std::ptrdiff_t x) { return std::clamp<std::ptrdiff_t>(x, 0, last); };
      blurred(u, inside(u - 2), inside(u - 1), inside(u + 1), inside(u + 2));
    }
  }

  const std::vector<float>& light_;
  std::size_t width_;
  int height_;
  std::array<float, 3> weights_{1, 0, 0};
  std::vector<float> mixed_;
};

}  // namespace

float exposure_gain(const NoiseOptions& noise, double time_s) {
  Rng rng(noise.seed, "exposure", 0);
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    sum += std::sin(2 * std::numbers::pi * (rng.uniform(0.05, 0.35) * time_s + rng.uniform())) / 3;
  return static_cast<float>(1 + noise.exposure_amplitude * sum);
}

void develop(const NoiseOptions& noise, int frame, float scale, const std::vector<float>& colour,
             Image<Rgb>& rgb) {
  Rng rng(noise.seed, "image_noise", static_cast<std::uint64_t>(frame));
  const NoiseTable table(rng, noise.image_noise ? noise.image_sigma : 0);
  const auto width = static_cast<std::size_t>(rgb.width);
  std::vector<float> row(3 * width);
  Optics5 optics(noise.softness_px, colour, rgb.width, rgb.height);
  for (int v = 0; v < rgb.height; ++v) {
    optics.row(v, scale, row);
    if (noise.image_noise) {
      // Stretches of at most a table's length, so that images of any width work.
      for (std::size_t begin = 0; begin < width; begin += table_size / 4) {
        const std::size_t count = std::min(width - begin, table_size / 4);
        const float* common = table.stretch(rng, count);
        const float* own = table.stretch(rng, 3 * count);
        for (std::size_t i = 0; i < count; ++i)
          for (std::size_t k = 0; k < 3; ++k)
            row[3 * (begin + i) + k] += common_share * common[i] + own_share * own[3 * i + k];
      }
    }
    Rgb* out = &rgb.at(0, v);
    const auto byte = [](float x) { return static_cast<std::uint8_t>(std::clamp(x, 0.0f, 255.0f)); };
    for (std::size_t u = 0; u < width; ++u)
      out[u] = {byte(row[3 * u]), byte(row[3 * u + 1]), byte(row[3 * u + 2])};
  }
}

}  // namespace vsgraphs
