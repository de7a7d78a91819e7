// Which way is up, from ground and walls together: the direction to which most of the seen surface stands upright or lies
// level, near to the image's own up. (Manhattan-world voting after Coughlan and Yuille, ICCV 1999, for the vertical
// alone: walls need not be at right angles to each other.)
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace vsgraphs {

struct UprightEvidence {
  Eigen::Vector3d normal;         // unit, towards the side that saw it
  double area_m2 = 0;             // seen of it
  bool below_the_camera = false;  // looks up at the cameras that saw it
};

struct UpDirectionOptions {
  double max_tilt_rad = 0.7;    // between the camera's own up and the real one
  double tolerance_rad = 0.07;  // of a surface from upright or level
  double min_area_m2 = 1.0;     // of ground, or of each of two walls
  double min_share = 0.5;       // of the seen area that must agree
};

// Empty where ground, or two walls that are not parallel, do not agree on it yet. `image_up`: unit, the mean of the
// cameras' own up. O(n^3) in the surfaces, of which the largest 24 are used.
std::optional<Eigen::Vector3d> find_up(std::vector<UprightEvidence> surfaces, const Eigen::Vector3d& image_up,
                                       const UpDirectionOptions& options = {});

}  // namespace vsgraphs
