// Images for tests and benchmarks: overlapping shaded discs and boxes at all sizes (the "dead leaves" model,
// whose statistics are close to those of photographs), and views of them turned, scaled and shifted.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/base/image.h"
#include "core/base/rng.h"

namespace vsgraphs::test {

inline Image<std::uint8_t> textured_image(int width, int height, std::uint64_t seed) {
  Rng rng(seed, "textured_image", 0);
  Image<std::uint8_t> image(width, height, 128);
  for (int leaf = 0; leaf < width * height / 400; ++leaf) {
    const double size = 3.0 / std::sqrt(rng.uniform(0.004, 1.0));  // 3..47 px, many small
    const double u0 = rng.uniform(0, width), v0 = rng.uniform(0, height),
                 turn = rng.uniform(0, std::numbers::pi);
    const double grey = rng.uniform(20, 235), shade_u = rng.uniform(-1, 1), shade_v = rng.uniform(-1, 1);
    const bool box = rng.uniform() < 0.6;
    const double c = std::cos(turn), s = std::sin(turn);
    const int reach = static_cast<int>(size * 1.5) + 1;
    for (int v = std::max(0, static_cast<int>(v0) - reach);
         v <= std::min(height - 1, static_cast<int>(v0) + reach); ++v) {
      for (int u = std::max(0, static_cast<int>(u0) - reach);
           u <= std::min(width - 1, static_cast<int>(u0) + reach); ++u) {
        const double du = u - u0, dv = v - v0;
        const bool inside = box ? std::abs(c * du + s * dv) < size && std::abs(c * dv - s * du) < 0.7 * size
                                : du * du + dv * dv < size * size;
        if (!inside) continue;
        image.at(u, v) =
            static_cast<std::uint8_t>(std::clamp(grey + shade_u * du + shade_v * dv, 0.0, 255.0));
      }
    }
  }
  return image;
}

// The image seen through `from_new`, which takes new pixels to old ones (2x3: linear part and shift). Pixels
// are averaged over 3x3 samples, so that shrinking does not alias.
inline Image<std::uint8_t> warped(const Image<std::uint8_t>& image,
                                  const Eigen::Matrix<double, 2, 3>& from_new) {
  Image<std::uint8_t> out(image.width, image.height);
  const auto sample = [&](double u, double v) {
    u = std::clamp(u, 0.0, image.width - 1.001);
    v = std::clamp(v, 0.0, image.height - 1.001);
    const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
    const double fu = u - u0, fv = v - v0;
    return (image.at(u0, v0) * (1 - fu) + image.at(u0 + 1, v0) * fu) * (1 - fv) +
           (image.at(u0, v0 + 1) * (1 - fu) + image.at(u0 + 1, v0 + 1) * fu) * fv;
  };
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      double sum = 0;
      for (int k = 0; k < 9; ++k) {
        const Eigen::Vector2d at =
            from_new * Eigen::Vector3d(u + (k % 3 - 1) / 3.0, v + (k / 3 - 1) / 3.0, 1);
        sum += sample(at.x(), at.y());
      }
      out.at(u, v) = static_cast<std::uint8_t>(std::lround(sum / 9));
    }
  }
  return out;
}

// A turn by `angle_rad` (clockwise on the screen) and a growth by `scale` about the image's centre, then a
// shift, as the map from new pixels to old ones.
inline Eigen::Matrix<double, 2, 3> similarity(const Image<std::uint8_t>& image, double angle_rad,
                                              double scale,
                                              const Eigen::Vector2d& shift = Eigen::Vector2d::Zero()) {
  const Eigen::Vector2d centre((image.width - 1) / 2.0, (image.height - 1) / 2.0);
  Eigen::Matrix<double, 2, 3> from_new;
  from_new.leftCols<2>() = Eigen::Rotation2Dd(-angle_rad).toRotationMatrix() / scale;
  from_new.col(2) = centre - from_new.leftCols<2>() * (centre + shift);
  return from_new;
}

}  // namespace vsgraphs::test
