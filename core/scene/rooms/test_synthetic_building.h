// For tests: rooms with straight walls, doors and boxes, and a depth camera that walks through them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <vector>

#include "core/base/rng.h"
#include "core/geometry/polygon.h"
#include "core/scene/rooms/surfaces.h"
#include "core/scene/space/free_space.h"

namespace vsgraphs::test {

struct TestRoom {
  Polygon2 polygon;  // counter-clockwise
  double z = 0, height = 2.6;
};

// A hole through all walls around its middle.
struct TestDoor {
  Eigen::Vector2d center, normal;
  double width = 0.9, height = 2.05, z = 0, depth = 0.25;  // depth: half the thickness it cuts through
};

struct TestBox {
  Eigen::Vector2d center, half;
  double low = 0, high = 0.8, yaw_rad = 0;
};

struct TestBuilding {
  std::vector<TestRoom> rooms;
  std::vector<TestDoor> doors;
  std::vector<TestBox> boxes;

  // Turns everything about the origin.
  TestBuilding turned(double degrees) const {
    TestBuilding result = *this;
    const Eigen::Rotation2Dd turn(degrees * std::numbers::pi / 180);
    for (TestRoom& room : result.rooms)
      for (Eigen::Vector2d& p : room.polygon) p = turn * p;
    for (TestDoor& door : result.doors) {
      door.center = turn * door.center;
      door.normal = turn * door.normal;
    }
    for (TestBox& box : result.boxes) {
      box.center = turn * box.center;
      box.yaw_rad += turn.angle();
    }
    return result;
  }
};

inline Polygon2 rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

// Walks, looks and remembers what it saw of walls, grounds and ceilings.
class TestWalk {
 public:
  TestWalk(const TestBuilding& building, std::uint64_t seed)
      : building_(building), rng_(seed, "test_walk", 0) {
    for (std::size_t r = 0; r < building_.rooms.size(); ++r)
      for (std::size_t e = 0; e < building_.rooms[r].polygon.size(); ++e) add_wall(r, e);
    add_levels();
  }

  // Straight from point to point, a keyframe every 0.35 m, and a turn on the spot at each of them.
  void walk(const std::vector<Eigen::Vector2d>& way, double z = 0) {
    for (std::size_t i = 0; i < way.size(); ++i) {
      for (int k = 0; k < 10; ++k) look(way[i], z, k * 2 * std::numbers::pi / 10);
      if (i + 1 == way.size()) break;
      const Eigen::Vector2d step = way[i + 1] - way[i];
      const int count = static_cast<int>(step.norm() / 0.35);
      for (int k = 1; k <= count; ++k)
        look(way[i] + step * k / (count + 1), z, std::atan2(step.y(), step.x()));
    }
  }

  // One keyframe at eye height.
  void look(const Eigen::Vector2d& at, double z, double heading_rad) {
    constexpr double eye_m = 1.4, pitch_rad = -0.12;
    const Eigen::Vector3d forward(std::cos(heading_rad) * std::cos(pitch_rad),
                                  std::sin(heading_rad) * std::cos(pitch_rad), std::sin(pitch_rad));
    Eigen::Matrix3d axes;
    axes.col(2) = forward;
    axes.col(0) = Eigen::Vector3d(std::sin(heading_rad), -std::cos(heading_rad), 0);
    axes.col(1) = axes.col(2).cross(axes.col(0));
    const Se3 pose(axes, {at.x(), at.y(), z + eye_m});
    poses_.push_back({KeyframeId{static_cast<std::uint32_t>(poses_.size()), 0}, pose});
    depths_.push_back(std::make_shared<const DepthGrid>(render(pose)));
  }

  FreeSpace free_space(const FreeSpaceOptions& options = {}) const {
    FreeSpace space(options);
    for (std::size_t i = 0; i < poses_.size(); ++i)
      space.integrate(poses_[i].keyframe, depths_[i], poses_[i].level_from_camera);
    return space;
  }
  const std::vector<KeyframePose>& poses() const { return poses_; }
  const std::vector<std::shared_ptr<const DepthGrid>>& depths() const { return depths_; }

  // What was seen, thinned to one point per 0.1 m; faces with fewer than 25 points are left out. Walls are numbered
  // through all rooms, grounds from 1000, ceilings from 2000.
  SceneFaces faces() const {
    SceneFaces seen;
    for (const Surface& s : surfaces_)
      if (s.face.points.size() >= 25)
        (s.kind == 0 ? seen.walls : s.kind == 1 ? seen.grounds : seen.ceilings).push_back(s.face);
    return seen;
  }
  // The same, each wall point at the middle of its cell of 0.1 m, the way maps keep them. Cells begin `phase_m` above a
  // multiple of their size.
  SceneFaces faces_in_cells(double phase_m) const {
    SceneFaces seen = faces();
    for (SceneFace& wall : seen.walls)
      for (Eigen::Vector3f& p : wall.points)
        p.z() = static_cast<float>((std::floor((p.z() - phase_m) / 0.1) + 0.5) * 0.1 + phase_m);
    return seen;
  }
  // Ids of a room's walls, as seen in faces().
  std::vector<PlaneId> walls_of(std::size_t room) const {
    std::vector<PlaneId> ids;
    for (const Surface& s : surfaces_)
      if (s.kind == 0 && s.room == room && s.face.points.size() >= 25) ids.push_back(s.face.id);
    return ids;
  }

 private:
  struct Surface {
    int kind = 0;  // 0 wall, 1 ground, 2 ceiling
    std::size_t room = 0;
    Eigen::Vector2d from{0, 0}, to{0, 0};
    double low = 0, high = 0;
    SceneFace face;
    std::set<std::array<int, 3>> thinned;
  };

  void add_wall(std::size_t r, std::size_t e) {
    const TestRoom& room = building_.rooms[r];
    Surface s;
    s.room = r;
    s.from = room.polygon[e];
    s.to = room.polygon[(e + 1) % room.polygon.size()];
    s.low = room.z;
    s.high = room.z + room.height;
    const Eigen::Vector2d along = (s.to - s.from).normalized();
    s.face.id.index = static_cast<std::uint32_t>(surfaces_.size());
    s.face.plane.normal = {-along.y(), along.x(), 0};
    s.face.plane.anchor = {s.from.x(), s.from.y(), room.z};
    surfaces_.push_back(std::move(s));
  }

  // One ground and one ceiling for all rooms of one height.
  void add_levels() {
    std::map<double, std::size_t> known;
    for (const double sign : {1.0, -1.0})
      for (const TestRoom& room : building_.rooms) {
        const double z = sign > 0 ? room.z : room.z + room.height;
        std::size_t& index = level_of_[{sign > 0, z}];
        if (index != 0) continue;
        Surface s;
        s.kind = sign > 0 ? 1 : 2;
        s.low = s.high = z;
        s.face.id.index = static_cast<std::uint32_t>((sign > 0 ? 1000 : 2000) + known.size());
        s.face.plane.normal = {0, 0, sign};
        s.face.plane.anchor = {0, 0, z};
        index = surfaces_.size();
        known[z] = index;
        surfaces_.push_back(std::move(s));
      }
  }

  bool in_door(const Eigen::Vector3d& p) const {
    for (const TestDoor& door : building_.doors) {
      const Eigen::Vector2d to = p.head<2>() - door.center;
      const Eigen::Vector2d along(-door.normal.y(), door.normal.x());
      if (std::abs(to.dot(along)) < 0.5 * door.width && std::abs(to.dot(door.normal)) < door.depth &&
          p.z() > door.z - 0.01 && p.z() < door.z + door.height)
        return true;
    }
    return false;
  }

  // Distance along the ray and the surface hit (none: furniture).
  std::pair<double, int> cast(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) const {
    double best = 1e9;
    int hit = -1;
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      const Surface& s = surfaces_[i];
      const Eigen::Vector3d& n = s.face.plane.normal;
      const double rate = n.dot(ray);
      if (std::abs(rate) < 1e-9) continue;
      const double t = -s.face.plane.signed_distance(from) / rate;
      if (t < 1e-6 || t >= best || !covers(s, from + t * ray)) continue;
      best = t;
      hit = rate < 0 ? static_cast<int>(i) : -1;  // from behind: the reveal of a door
    }
    for (const TestBox& box : building_.boxes) {
      const double t = cast_box(box, from, ray);
      if (t < best) {
        best = t;
        hit = -1;
      }
    }
    return {best, hit};
  }

  bool covers(const Surface& s, const Eigen::Vector3d& p) const {
    if (s.kind == 0) {
      const Eigen::Vector2d along = (s.to - s.from).normalized();
      const double t = along.dot(p.head<2>() - s.from);
      return t > -0.01 && t < (s.to - s.from).norm() + 0.01 && p.z() >= s.low && p.z() <= s.high &&
             !in_door(p);
    }
    for (const TestRoom& room : building_.rooms)
      if ((s.kind == 1 ? room.z : room.z + room.height) == s.low && contains(room.polygon, p.head<2>()))
        return true;
    return s.kind == 1 && in_door(p);
  }

  static double cast_box(const TestBox& box, const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
    const Eigen::Rotation2Dd back(-box.yaw_rad);
    Eigen::Vector3d o, d;
    o << back * (from.head<2>() - box.center), from.z();
    d << back * ray.head<2>(), ray.z();
    const Eigen::Vector3d low(-box.half.x(), -box.half.y(), box.low),
        high(box.half.x(), box.half.y(), box.high);
    double enter = 0, leave = 1e9;
    for (int a = 0; a < 3; ++a) {
      if (std::abs(d[a]) < 1e-12) {
        if (o[a] < low[a] || o[a] > high[a]) return 1e9;
        continue;
      }
      const double t0 = (low[a] - o[a]) / d[a], t1 = (high[a] - o[a]) / d[a];
      enter = std::max(enter, std::min(t0, t1));
      leave = std::min(leave, std::max(t0, t1));
    }
    return enter > 1e-6 && enter <= leave ? enter : 1e9;
  }

  DepthGrid render(const Se3& pose) {
    constexpr double focal_px = 525;
    DepthGrid grid;
    grid.columns = 80;
    grid.rows = 60;
    grid.samples.resize(4800);
    for (int r = 0; r < grid.rows; ++r)
      for (int c = 0; c < grid.columns; ++c) {
        const Eigen::Vector3d ray((c * 8 + 4 - 319.5) / focal_px, (r * 8 + 4 - 239.5) / focal_px, 1);
        const auto [depth, hit] = cast(pose.translation(), pose.rotation() * ray);
        if (depth > 6.0) continue;
        const double noisy = depth + rng_.normal() * (0.0012 + 0.0019 * (depth - 0.4) * (depth - 0.4));
        grid.samples[static_cast<std::size_t>(r * grid.columns + c)].point = (ray * noisy).cast<float>();
        if (hit >= 0 && depth < 4.0)
          remember(surfaces_[static_cast<std::size_t>(hit)], pose * (ray * noisy).eval());
      }
    return grid;
  }

  static void remember(Surface& s, const Eigen::Vector3d& p) {
    if (std::abs(s.face.plane.signed_distance(p)) > 0.03) return;
    const Eigen::Array3i voxel = (p.array() * 10).floor().cast<int>();
    if (s.thinned.insert({voxel.x(), voxel.y(), voxel.z()}).second) s.face.points.push_back(p.cast<float>());
  }

  TestBuilding building_;
  Rng rng_;
  std::vector<Surface> surfaces_;
  std::map<std::pair<bool, double>, std::size_t> level_of_;
  std::vector<KeyframePose> poses_;
  std::vector<std::shared_ptr<const DepthGrid>> depths_;
};

// Intersection over union of two polygons, on a raster of 4 cm.
inline double overlap(const Polygon2& a, const Polygon2& b) {
  Eigen::Vector2d low = a[0], high = a[0];
  for (const Polygon2* polygon : {&a, &b})
    for (const Eigen::Vector2d& p : *polygon) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  int both = 0, any = 0;
  for (double y = low.y(); y < high.y(); y += 0.04)
    for (double x = low.x(); x < high.x(); x += 0.04) {
      const bool in_a = contains(a, {x, y}), in_b = contains(b, {x, y});
      both += in_a && in_b;
      any += in_a || in_b;
    }
  return any ? static_cast<double>(both) / any : 0;
}

}  // namespace vsgraphs::test
