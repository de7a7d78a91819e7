// Brightness and noise of the colour image.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/check.h"
#include "core/base/rng.h"
#include "core/simulate/sensor_noise.h"

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
  for (int v = 0; v < rgb.height; ++v) {
    const float* in = colour.data() + 3 * width * static_cast<std::size_t>(v);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = scale * in[i] + 0.5f;
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
