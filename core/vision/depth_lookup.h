// Depth at a feature: a number that can be trusted, or none. Corners like to sit where two surfaces meet in
// the image, and there the sensor's pixel belongs to one or the other by chance.
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "core/geometry/camera.h"

namespace vsgraphs {

// A depth image as the user has it: raw sensor units (camera.depth_scale per metre) or metres. Exactly one of
// the two is filled; the pixels stay the caller's and must outlive the call they are handed to.
struct DepthView {
  ImageView<std::uint16_t> raw;
  ImageView<float> metres;
};

class DepthLookup {
 public:
  explicit DepthLookup(const Camera& camera);

  // Throws InputError unless exactly one image is filled and has the camera's size.
  void validate(const DepthView& depth) const;

  // Depth along the optical axis (m) at a distorted pixel, or 0. Bilinear between the four pixels around it;
  // 0 where one of them or of the nearest pixel's four neighbours is invalid, out of range, or off by more
  // than noise and a steep surface explain. About 10 ns; the view must have passed `validate`.
  double at(const DepthView& depth, double raw_u, double raw_v) const;

  // Depth of one pixel (m), 0 where invalid or out of the camera's range.
  double pixel(const DepthView& depth, int u, int v) const;

 private:
  double metres_of(std::uint16_t raw) const;
  double metres_of(float metres) const;
  template <typename T>
  double interpolate(const ImageView<T>& image, double u, double v) const;

  Camera camera_;
  double metres_per_unit_;
  double
      slope_per_px_;  // depth step between neighbouring pixels per metre of depth, steepest surface believed
};

}  // namespace vsgraphs
