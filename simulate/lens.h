// How a lens bends what a pinhole would show. Normalised image coordinates: x/z, y/z of the ideal pinhole and (pixel - centre) / focal
// length of the lens. Brown (1966); Kannala and Brandt, "A generic camera model and calibration method for conventional, wide-angle, and
// fish-eye lenses" (PAMI 2006), the odd powers up to theta^9; rational: Claus and Fitzgibbon (CVPR 2005) as OpenCV parametrises it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/geometry/camera.h"

namespace vsgraphs {

struct Lens {
  std::string model = "none";  // none | radial_tangential | kannala_brandt | rational
  std::vector<double> k;       // k1 k2 p1 p2 k3 | k1..k4 | k1 k2 p1 p2 k3 k4 k5 k6; those left out are 0

  bool bends() const { return model != "none"; }
  void validate() const;  // InputError naming what is wrong
  Eigen::Vector2d distort(const Eigen::Vector2d& ideal) const;
  // The ideal point that `distort` takes here; Newton's method. InputError where there is none.
  Eigen::Vector2d undistort(const Eigen::Vector2d& bent) const;
  // The same, sought from a point nearby.
  Eigen::Vector2d undistort(const Eigen::Vector2d& bent, const Eigen::Vector2d& near) const;
};

// Where a pinhole image shows what each pixel of the lens's image sees: the image is rendered there and picked from.
class LensMap {
 public:
  // offsets: places within a pixel. InputError where the lens sees more than a pinhole image can hold.
  LensMap(const Camera& camera, const Lens& lens, const std::vector<Eigen::Vector2d>& offsets);

  const Camera& pinhole() const { return pinhole_; }
  Eigen::Vector2f at(std::size_t offset, int u, int v) const { return maps_[offset].at(u, v); }
  // Rows of the pinhole image that rows begin..end of the lens's image look at.
  std::array<int, 2> rows(int begin, int end) const;

 private:
  Camera pinhole_;
  std::vector<Image<Eigen::Vector2f>> maps_;
};

}  // namespace vsgraphs
