#include "simulate/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/scene.h"

namespace vsgraphs {
namespace {

constexpr double turn_rad_s = 2.0;  // on the spot, at the corners of a way

Eigen::Matrix3d about_z(double angle) { return so3_exp({0, 0, angle}); }

}  // namespace

Walk::Walk(const std::vector<Eigen::Vector2d>& way, double speed, double start_s, double yaw_rad, double z)
    : start_s_(start_s), z_(z) {
  std::vector<Eigen::Vector2d> round = way;  // there and back
  for (std::size_t i = way.size(); i-- > 1;) round.push_back(way[i - 1]);
  if (way.size() == 1) {
    knots_.push_back({0, 0, yaw_rad, way.front()});
    return;
  }
  double time = 0, walked = 0, yaw = 0;
  for (std::size_t i = 0; i + 1 < round.size(); ++i) {
    const Eigen::Vector2d leg = round[i + 1] - round[i];
    const double heading = std::atan2(leg.y(), leg.x());
    const double turn = i == 0 ? 0.0 : std::remainder(heading - yaw, 2 * std::numbers::pi);
    if (i == 0) yaw = heading, knots_.push_back({0, 0, yaw, round[0]});
    time += std::abs(turn) / turn_rad_s, yaw += turn;
    knots_.push_back({time, walked, yaw, round[i]});
    time += leg.norm() / speed, walked += leg.norm();
    knots_.push_back({time, walked, yaw, round[i + 1]});
  }
  // Turned as at the start again, so that rounds follow one another.
  const double last = std::remainder(knots_.front().yaw_rad - yaw, 2 * std::numbers::pi);
  knots_.push_back({time + std::abs(last) / turn_rad_s, walked, yaw + last, round.front()});
}

Walk::Knot Walk::knot_at(double time_s) const {
  const double since = std::max(0.0, time_s - start_s_), period = knots_.back().time_s;
  if (period <= 0) return knots_.front();
  const double rounds = std::floor(since / period), t = since - rounds * period;
  const auto next =
      std::upper_bound(knots_.begin(), knots_.end(), t, [](double x, const Knot& k) { return x < k.time_s; });
  if (next == knots_.end()) return knots_.back();
  const Knot& b = *next;
  const Knot& a = *(next - 1);
  const double share = (t - a.time_s) / (b.time_s - a.time_s);
  return {time_s, rounds * knots_.back().walked_m + a.walked_m + share * (b.walked_m - a.walked_m),
          a.yaw_rad + share * (b.yaw_rad - a.yaw_rad), a.at + share * (b.at - a.at)};
}

Se3 Walk::world_from_body(double time_s) const {
  const Knot k = knot_at(time_s);
  return {about_z(k.yaw_rad), {k.at.x(), k.at.y(), z_}};
}

double Walk::walked_m(double time_s) const { return knot_at(time_s).walked_m; }

bool Walk::walking(double time_s) const { return walked_m(time_s + 0.05) > walked_m(time_s - 0.05) + 1e-6; }

double hinge_angle(const Mover& mover, double time_s) {
  double angle = mover.turns.empty() ? 0.0 : mover.turns.front().y();
  for (std::size_t i = 1; i < mover.turns.size() && mover.turns[i].x() <= time_s; ++i) {
    const double way = mover.turns[i].y() - angle, most = door_swing_rad_s * (time_s - mover.turns[i].x());
    const bool more = i + 1 < mover.turns.size() && mover.turns[i + 1].x() <= time_s;
    const double until = more ? door_swing_rad_s * (mover.turns[i + 1].x() - mover.turns[i].x()) : most;
    angle += std::clamp(way, -until, until);
  }
  return angle;
}

Se3 Scene::world_from_mover(int mover, double time_s) const {
  if (mover < 0) return {};
  const Mover& m = movers[static_cast<std::size_t>(mover)];
  if (m.kind == Mover::Kind::rig) return path.world_from_camera(time_s) * m.base;
  if (m.kind == Mover::Kind::hinge)
    return m.base * Se3(about_z(hinge_angle(m, time_s)), Eigen::Vector3d::Zero());
  const Walk& walk = walks[static_cast<std::size_t>(m.walk)];
  const double phase = 2 * std::numbers::pi * walk.walked_m(time_s) / stride_m;
  const double swing = walk.walking(time_s) ? m.swing_rad * std::sin(phase) : 0.0;
  return walk.world_from_body(time_s) * m.base * Se3(so3_exp({0, swing, 0}), Eigen::Vector3d::Zero());
}

}  // namespace vsgraphs
