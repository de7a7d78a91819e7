// What moves while the camera is under way: door leaves, limbs of people and trolleys, the robot that carries the camera. The
// place of each is a function of time alone.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/se3.h"

namespace vsgraphs {

// A way walked to and fro without end, or a place where somebody stays.
class Walk {
 public:
  Walk() = default;
  // way: at least one point; stays where it starts if there is only one, looking along yaw_rad.
  Walk(const std::vector<Eigen::Vector2d>& way, double speed, double start_s, double yaw_rad, double z);

  // x forward, y to the left, z up, on the ground.
  Se3 world_from_body(double time_s) const;
  double walked_m(double time_s) const;  // since the start
  bool walking(double time_s) const;

 private:
  struct Knot {
    double time_s, walked_m, yaw_rad;
    Eigen::Vector2d at;
  };
  Knot knot_at(double time_s) const;
  std::vector<Knot> knots_;  // of one round
  double start_s_ = 0, z_ = 0;
};

struct Mover {
  enum class Kind { hinge, limb, rig } kind = Kind::hinge;
  Se3 base;  // hinge: world_from_leaf at angle 0, turning about z; limb: body_from_joint; rig: camera_from_part
  std::vector<Eigen::Vector2d> turns;  // hinge: (time in s, angle in rad), in order
  int walk = -1;                       // limb: index in Scene::walks
  double swing_rad = 0;                // limb: largest swing about y; negative: in the other half of the step
};

inline constexpr double stride_m = 1.4;  // two steps
inline constexpr double door_swing_rad_s = 1.2;

// The leaf's angle: it swings to each new one at a steady rate from that one's time on.
double hinge_angle(const Mover& mover, double time_s);

}  // namespace vsgraphs
