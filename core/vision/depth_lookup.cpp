#include "core/vision/depth_lookup.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

constexpr double steepest_slope =
    4.0;  // tangent of the angle between view ray and surface normal: 76 degrees
constexpr double noise_sigmas = 3.0;

}  // namespace

DepthLookup::DepthLookup(const Camera& camera)
    : camera_(camera),
      metres_per_unit_(1.0 / camera.depth_scale),
      slope_per_px_(steepest_slope / std::min(camera.fx, camera.fy)) {
  camera_.validate();
}

void DepthLookup::validate(const DepthView& depth) const {
  require_input(depth.raw.empty() != depth.metres.empty(),
                "depth: give exactly one of the 16-bit raw image and the float image in metres");
  const int width = depth.raw.empty() ? depth.metres.width : depth.raw.width;
  const int height = depth.raw.empty() ? depth.metres.height : depth.raw.height;
  require_input(width == camera_.width && height == camera_.height,
                "depth: the image is " + std::to_string(width) + "x" + std::to_string(height) +
                    " but the camera says " + std::to_string(camera_.width) + "x" +
                    std::to_string(camera_.height) + "; correct the camera's width and height");
}

double DepthLookup::metres_of(std::uint16_t raw) const {
  for (std::uint16_t invalid : camera_.invalid_depth)
    if (raw == invalid) return 0;
  return metres_of(static_cast<float>(raw * metres_per_unit_));
}

double DepthLookup::metres_of(float metres) const {
  // Written so that NaN fails.
  return metres >= camera_.depth_min_m && metres <= camera_.depth_max_m ? static_cast<double>(metres) : 0.0;
}

double DepthLookup::pixel(const DepthView& depth, int u, int v) const {
  return depth.raw.empty() ? metres_of(depth.metres.at(u, v)) : metres_of(depth.raw.at(u, v));
}

double DepthLookup::at(const DepthView& depth, double raw_u, double raw_v) const {
  return depth.raw.empty() ? interpolate(depth.metres, raw_u, raw_v) : interpolate(depth.raw, raw_u, raw_v);
}

template <typename T>
double DepthLookup::interpolate(const ImageView<T>& image, double u, double v) const {
  // A pixel of margin on every side for the neighbours; written so that NaN fails.
  if (!(u >= 1 && v >= 1 && u < image.width - 2 && v < image.height - 2)) return 0;
  const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
  const double fu = u - u0, fv = v - v0;
  const int nearest_u = u0 + (fu >= 0.5), nearest_v = v0 + (fv >= 0.5);
  const double nearest = metres_of(image.at(nearest_u, nearest_v));
  if (nearest == 0) return 0;

  const double tolerance_m = noise_sigmas * camera_.depth_noise.sigma_m(nearest) + slope_per_px_ * nearest;
  const auto fits = [&](double z) { return z != 0 && std::abs(z - nearest) <= tolerance_m; };
  const double z00 = metres_of(image.at(u0, v0)), z10 = metres_of(image.at(u0 + 1, v0));
  const double z01 = metres_of(image.at(u0, v0 + 1)), z11 = metres_of(image.at(u0 + 1, v0 + 1));
  if (!fits(z00) || !fits(z10) || !fits(z01) || !fits(z11)) return 0;
  // Two of the nearest pixel's neighbours are in the square already; the other two lie on its far side.
  const int far_u = nearest_u == u0 ? u0 - 1 : u0 + 2, far_v = nearest_v == v0 ? v0 - 1 : v0 + 2;
  if (!fits(metres_of(image.at(far_u, nearest_v))) || !fits(metres_of(image.at(nearest_u, far_v)))) return 0;

  return (z00 * (1 - fu) + z10 * fu) * (1 - fv) + (z01 * (1 - fu) + z11 * fu) * fv;
}

}  // namespace vsgraphs
