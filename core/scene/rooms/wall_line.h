// A wall face seen from above: a line, and the stretches of it that were seen.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/scene/rooms/level_map.h"
#include "core/scene/rooms/surfaces.h"

namespace vsgraphs {

class WallLine {
 public:
  // Nothing where the face is not vertical within 25 deg or none of its points lies between the level's ground and
  // wall_high_m.
  static std::optional<WallLine> from_face(const SceneFace& face, double ground_m,
                                           const LevelOptions& options);

  PlaneId id() const { return id_; }
  const Eigen::Vector2d& normal() const { return normal_; }              // unit, into the room
  Eigen::Vector2d along() const { return {normal_.y(), -normal_.x()}; }  // the room lies to its left
  double distance(const Eigen::Vector2d& point) const { return normal_.dot(point) + offset_m_; }
  double coordinate(const Eigen::Vector2d& point) const { return along().dot(point); }
  Eigen::Vector2d point(double coordinate) const { return coordinate * along() - offset_m_ * normal_; }
  double from_m() const { return from_m_; }  // first and last coordinate seen
  double to_m() const { return to_m_; }
  // Middle of what was seen, on the line.
  Eigen::Vector2d middle() const { return point(0.5 * (from_m_ + to_m_)); }

  // Metres of the stretch [from, to] on which wall was seen at any height (`in_band`: at a height where a door would be
  // open). Gaps narrower than 0.35 m count as seen.
  double seen_m(double from, double to, bool in_band) const;
  double seen_m() const { return seen_m(from_m_, to_m_, false); }

 private:
  void mark(std::span<const Eigen::Vector3f> points, double low_m, double high_m,
            std::vector<char>& seen) const;

  static constexpr double bin_m = 0.1;
  PlaneId id_;
  Eigen::Vector2d normal_ = Eigen::Vector2d::UnitX();
  double offset_m_ = 0, from_m_ = 0, to_m_ = 0;
  std::vector<char> seen_, seen_in_band_;  // by bins from from_m_
};

std::vector<WallLine> wall_lines(std::span<const SceneFace> walls, double ground_m,
                                 const LevelOptions& options);

}  // namespace vsgraphs
