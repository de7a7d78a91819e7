// Light on every face, worked out once: the room's lamps and windows (no cast shadows), a share of ambient light, and the
// darkening near corners and beside furniture that makes a rendered room look solid.
#include <algorithm>
#include <cmath>

#include "simulate/scene_builder.h"

namespace vsgraphs {
namespace {

constexpr double node_spacing_m = 0.2;
constexpr int max_nodes = 96;
constexpr double ambient = 0.46;
constexpr double corner_reach_m = 0.28, corner_depth = 0.3;

struct RoomLights {
  std::vector<Light> lights;
  std::vector<const Solid*> solids;
};

double from_lights(const std::vector<Light>& lights, const Eigen::Vector3d& p, const Eigen::Vector3d& n) {
  double sum = 0;
  for (const Light& light : lights) {
    const Eigen::Vector3d to = light.position - p;
    const double r2 = to.squaredNorm() + 0.4, r = std::sqrt(r2);
    // Half-Lambert keeps faces turned away from every lamp from going black: rooms are full of bounced light.
    const double facing = 0.25 + 0.75 * std::max(0.0, to.dot(n) / r);
    const double leaving = 0.35 + 0.65 * std::max(0.0, -to.dot(light.direction) / r);
    sum += light.power * facing * leaving / (0.6 + r2);
  }
  return sum;
}

double shade(double distance, double share = 1) {
  return 1 - share * corner_depth * std::exp(-distance / corner_reach_m);
}

// Nearby surfaces that hide part of the room from p: walls, floor and ceiling unless p lies on them, and furniture.
double openness(const Scene& scene, int room, const RoomLights& near, const Eigen::Vector3d& p,
                const Eigen::Vector3d& n) {
  const auto r = static_cast<std::size_t>(room);
  const RoomPlan& plan = scene.plan.rooms[r];
  double open = 1;
  for (const int w : scene.rooms[r].walls) {
    const WallGeometry& wall = scene.walls[static_cast<std::size_t>(w)];
    const double facing = n.head<2>().dot(wall.normal);
    if (facing < 0.9) open *= shade(distance_to_segment(p.head<2>(), wall.p0, wall.p1));
  }
  if (n.z() < 0.9) open *= shade(std::abs(p.z() - plan.z_floor));
  if (n.z() > -0.9) open *= shade(std::abs(plan.z_floor + plan.height - p.z()));
  for (const Solid* solid : near.solids) {
    const Eigen::Vector2d d = p.head<2>() - solid->center;
    const double c = std::cos(solid->yaw_rad), s = std::sin(solid->yaw_rad);
    const double x = std::abs(c * d.x() + s * d.y()) - solid->half.x(),
                 y = std::abs(-s * d.x() + c * d.y()) - solid->half.y();
    const double z = std::max(solid->z_min - p.z(), p.z() - solid->z_max);
    if (std::max({x, y, z}) < 0.02) continue;  // on or in the piece itself
    open *= shade(std::hypot(std::max(x, 0.0), std::max(y, 0.0), std::max(z, 0.0)), solid->shading);
  }
  return open;
}

Lightmap light_face(const Scene& scene, const Face& face, const RoomLights& near) {
  Lightmap map;
  const auto nodes = [](double size) {
    return std::clamp(static_cast<int>(std::ceil(size / node_spacing_m)), 1, max_nodes) + 1;
  };
  map.width = nodes(face.size.x()), map.height = nodes(face.size.y());
  map.nodes_per_s = static_cast<float>((map.width - 1) / face.size.x());
  map.nodes_per_t = static_cast<float>((map.height - 1) / face.size.y());
  map.light.clear();
  const Eigen::Vector3d n = face.normal();
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      const double s = face.size.x() * i / (map.width - 1), t = face.size.y() * j / (map.height - 1);
      const Eigen::Vector3d p = face.origin + s * face.s_axis + t * face.t_axis;
      const double open = openness(scene, face.room, near, p, n);
      map.light.push_back(static_cast<float>(
          open * (ambient * scene.plan.rooms[static_cast<std::size_t>(face.room)].brightness +
                  0.9 * from_lights(near.lights, p, n))));
    }
  }
  return map;
}

}  // namespace

void light_scene(Scene& scene) {
  std::vector<RoomLights> rooms(scene.rooms.size());
  for (const Light& light : scene.lights) rooms[static_cast<std::size_t>(light.room)].lights.push_back(light);
  for (const Solid& solid : scene.solids) {
    for (std::size_t r = 0; r < rooms.size(); ++r)
      if (contains(scene.plan.rooms[r].polygon, solid.center)) rooms[r].solids.push_back(&solid);
  }
  for (Face& face : scene.faces) {
    if (face.emission > 0)
      face.lightmap.light = {face.emission};
    else if (face.mover >= 0)
      face.lightmap.light = {0.72f + 0.16f * static_cast<float>(face.normal().z())};
    else if (face.room < 0)
      face.lightmap.light = {0.7f};  // linings of doorways
    else
      face.lightmap = light_face(scene, face, rooms[static_cast<std::size_t>(face.room)]);
    if (face.lightmap.light.size() == 1) {  // a grid of 2 x 2 keeps sampling free of special cases
      face.lightmap.width = face.lightmap.height = 2;
      face.lightmap.light.assign(4, face.lightmap.light.front());
    }
  }
}

}  // namespace vsgraphs
