// Floors, ceilings, walls with their skirting boards, and ceiling lamps.
#include <algorithm>
#include <cmath>

#include "simulate/scene_builder.h"

namespace vsgraphs {
namespace {

constexpr Rgb skirting_colour{132, 78, 46};
constexpr double skirting_height_m = 0.08, skirting_depth_m = 0.014;
constexpr double lamp_spacing_m = 2.4;

Material floor_material(const RoomPlan& room, std::uint64_t seed) {
  if (room.floor == "wood") return {"planks", seed, {158, 122, 86}};
  if (room.floor == "carpet") return {"carpet", seed, {112, 118, 128}};
  if (room.floor == "terrazzo") return {"terrazzo", seed, {168, 158, 146}};
  if (room.floor == "concrete") return {"concrete", seed, {150, 150, 146}};
  return {"tiles", seed, {182, 172, 160}};
}

// The part of a polygon where limit . (x, y, 1) >= 0.
Polygon2 clipped(const Polygon2& polygon, const Eigen::Vector3d& limit) {
  Polygon2 out;
  const auto over = [&](const Eigen::Vector2d& p) { return limit.dot(p.homogeneous()); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if (over(a) >= 0) out.push_back(a);
    if ((over(a) >= 0) != (over(b) >= 0)) out.push_back(a + over(a) / (over(a) - over(b)) * (b - a));
  }
  return out;
}

// Adds the part of the ceiling over `part`, which is flat there.
void add_ceiling_part(SceneAssembly& builder, const RoomPlan& room, const Tag& tag, const Polygon2& part,
                      const Eigen::Vector2d& away) {
  if (part.size() < 3) return;
  const auto lifted = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector3d(p.x(), p.y(), room.z_floor + ceiling_height(room, p));
  };
  // s along the knee wall, t towards it and down: the normal points into the room.
  const Eigen::Vector3d s(-away.y(), away.x(), 0);
  const Eigen::Vector2d inside = centroid(part);
  const Eigen::Vector3d t = (lifted(inside + 1e-3 * away) - lifted(inside)).normalized();
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  Polygon2 flat;
  for (const Eigen::Vector2d& p : part) {
    const Eigen::Vector3d at = lifted(p) - lifted(inside);
    flat.emplace_back(s.dot(at), t.dot(at));
    low = low.cwiseMin(flat.back()), high = high.cwiseMax(flat.back());
  }
  for (Eigen::Vector2d& p : flat) p -= low;
  const Material cover{room.ceiling == "panels" ? "panels" : "paint", builder.plan().seed, {196, 198, 196}};
  builder.add_face(tag, lifted(inside) + low.x() * s + low.y() * t, s, t, high - low, {flat}, cover);
}

void add_sloped_ceiling(SceneAssembly& builder, int r, const Tag& tag) {
  const RoomPlan room = builder.plan().rooms[static_cast<std::size_t>(r)];
  const auto i = static_cast<std::size_t>(room.slope->wall);
  const Eigen::Vector2d p0 = room.polygon[i],
                        along = (room.polygon[(i + 1) % room.polygon.size()] - p0).normalized();
  const Eigen::Vector2d away(-along.y(), along.x());  // from the knee wall into the room
  const Eigen::Vector3d beyond(away.x(), away.y(), -away.dot(p0) - room.slope->reach);
  add_ceiling_part(builder, room, tag, clipped(room.polygon, beyond), away);
  add_ceiling_part(builder, room, tag, clipped(room.polygon, -beyond), away);
}

// A wall's upper edge from its p0 back to its p1, as (s, height).
Polygon2 wall_top(const WallGeometry& wall, const RoomPlan& room) {
  if (!room.slope) return {{wall.length, wall.height}, {0, wall.height}};
  Polygon2 top;
  constexpr int pieces = 64;  // the edge bends once; a thin sliver at the bend does not matter
  for (int k = 0; k <= pieces; ++k) {
    const double s = wall.length * (pieces - k) / pieces;
    top.emplace_back(s, ceiling_height(room, wall.p1 - s * wall.along));
  }
  return top;
}

void add_horizontal_faces(SceneAssembly& builder, int r, RoomGeometry& geometry) {
  const RoomPlan room = builder.plan().rooms[static_cast<std::size_t>(r)];
  Eigen::Vector2d low = room.polygon.front(), high = low;
  for (const auto& p : room.polygon) low = low.cwiseMin(p), high = high.cwiseMax(p);
  Polygon2 from_above, from_below;
  for (const auto& p : room.polygon) {
    from_above.push_back(p - low);
    from_below.emplace_back(p.x() - low.x(), high.y() - p.y());
  }
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  const Tag floor = builder.add_instance(SceneClass::floor, r);
  geometry.floor_instance = floor.instance;
  builder.add_face(floor, {low.x(), low.y(), room.z_floor}, x, y, high - low, {from_above},
                   floor_material(room, builder.plan().seed));
  const Tag ceiling = builder.add_instance(SceneClass::ceiling, r);
  geometry.ceiling_instance = ceiling.instance;
  if (room.slope) {
    add_sloped_ceiling(builder, r, ceiling);
    return;
  }
  const Material cover{room.ceiling == "panels" ? "panels" : "paint", builder.plan().seed, {196, 198, 196}};
  builder.add_face(ceiling, {low.x(), high.y(), room.z_floor + room.height}, x, -y, high - low, {from_below},
                   cover);
}

// The wall's outline seen from the room (s to the right, from p1 to p0): openings that reach the floor are notches.
std::vector<Polygon2> wall_contours(const WallGeometry& wall, const RoomPlan& room) {
  std::vector<Opening> notches;
  std::vector<Polygon2> contours(1);
  for (const Opening& o : wall.openings) {
    const double s0 = wall.length - o.along_max, s1 = wall.length - o.along_min;
    if (o.z_min < 1e-9)
      notches.push_back({s0, s1, 0, o.z_max});
    else
      contours.push_back({{s0, o.z_min}, {s1, o.z_min}, {s1, o.z_max}, {s0, o.z_max}});
  }
  std::sort(notches.begin(), notches.end(),
            [](const Opening& a, const Opening& b) { return a.along_min < b.along_min; });
  Polygon2& outline = contours.front();
  outline.emplace_back(0, 0);
  for (const Opening& n : notches) {
    for (const Eigen::Vector2d& p :
         Polygon2{{n.along_min, 0}, {n.along_min, n.z_max}, {n.along_max, n.z_max}, {n.along_max, 0}})
      outline.push_back(p);
  }
  outline.emplace_back(wall.length, 0);
  for (const Eigen::Vector2d& p : wall_top(wall, room)) outline.push_back(p);
  return contours;
}

void add_skirting(SceneAssembly& builder, const WallGeometry& wall, const Tag& tag) {
  std::vector<double> breaks{0};
  std::vector<Opening> low;
  for (const Opening& o : wall.openings)
    if (o.z_min < skirting_height_m) low.push_back(o);
  std::sort(low.begin(), low.end(),
            [](const Opening& a, const Opening& b) { return a.along_min < b.along_min; });
  for (const Opening& o : low) breaks.push_back(o.along_min), breaks.push_back(o.along_max);
  breaks.push_back(wall.length);
  const Stand stand{{wall.p0.x(), wall.p0.y(), wall.z_floor}, wall.along};
  const Material board{"grained", builder.plan().seed, skirting_colour};
  for (std::size_t i = 0; i + 1 < breaks.size(); i += 2) {
    builder.add_box(tag, stand, {breaks[i], 0, 0}, {breaks[i + 1], skirting_depth_m, skirting_height_m},
                    board, BoxSide::front | BoxSide::top | BoxSide::left | BoxSide::right);
  }
}

void add_walls(SceneAssembly& builder, int r, const RoomGeometry& geometry) {
  const RoomPlan& room = builder.plan().rooms[static_cast<std::size_t>(r)];
  const Material plaster{"paint", builder.plan().seed, room.wall_colour};
  for (const int w : geometry.walls) {
    WallGeometry& wall = builder.scene().walls[static_cast<std::size_t>(w)];
    const Tag tag = builder.add_instance(SceneClass::wall, r, "", wall.side);
    wall.instance = tag.instance;
    const Eigen::Vector3d corner(wall.p1.x(), wall.p1.y(), wall.z_floor),
        s_axis(-wall.along.x(), -wall.along.y(), 0);
    builder.add_face(tag, corner, s_axis, Eigen::Vector3d::UnitZ(), {wall.length, wall.height},
                     wall_contours(wall, room), plaster);
    if (room.skirting) add_skirting(builder, wall, tag);
  }
}

std::vector<Eigen::Vector2d> spread_lamps(const RoomPlan& room) {
  Eigen::Vector2d low = room.polygon.front(), high = low;
  for (const auto& p : room.polygon) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Eigen::Vector2d extent = high - low;
  const int nx = std::max(1, static_cast<int>(std::lround(extent.x() / lamp_spacing_m)));
  const int ny = std::max(1, static_cast<int>(std::lround(extent.y() / lamp_spacing_m)));
  std::vector<Eigen::Vector2d> lamps;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const Eigen::Vector2d p =
          low + Eigen::Vector2d((i + 0.5) * extent.x() / nx, (j + 0.5) * extent.y() / ny);
      if (contains(room.polygon, p) && distance_to_boundary(room.polygon, p) > 0.3) lamps.push_back(p);
    }
  }
  if (lamps.empty()) lamps.push_back(centroid(room.polygon));
  return lamps;
}

void add_lamps(SceneAssembly& builder, int r) {
  const RoomPlan room = builder.plan().rooms[static_cast<std::size_t>(r)];
  const WallGeometry& first =
      builder.scene()
          .walls[static_cast<std::size_t>(builder.scene().rooms[static_cast<std::size_t>(r)].walls[0])];
  const std::vector<Eigen::Vector2d> lamps = room.lamps ? *room.lamps : spread_lamps(room);
  const double top = room.z_floor + room.height;
  for (const Eigen::Vector2d& p : lamps) {
    const Tag tag = builder.add_instance(SceneClass::lamp, r, "ceiling light");
    const Stand stand{{p.x(), p.y(), top}, first.along};
    const std::size_t begin = builder.scene().faces.size();
    builder.add_box(tag, stand, {-0.6, -0.15, -0.05}, {0.6, 0.15, 0}, {"lacquer", 1, {225, 225, 220}},
                    all_sides & ~BoxSide::top);
    builder.scene().faces.back().emission = 1.25f;
    for (std::size_t i = begin; i + 1 < builder.scene().faces.size(); ++i)
      builder.scene().faces[i].emission = 0.7f;
    builder.scene().lights.push_back({{p.x(), p.y(), top - 0.06}, {0, 0, -1}, room.brightness, r});
  }
}

}  // namespace

double ceiling_height(const RoomPlan& room, const Eigen::Vector2d& at) {
  if (!room.slope) return room.height;
  const auto i = static_cast<std::size_t>(room.slope->wall);
  const Eigen::Vector2d p0 = room.polygon[i],
                        along = (room.polygon[(i + 1) % room.polygon.size()] - p0).normalized();
  const double distance = Eigen::Vector2d(-along.y(), along.x()).dot(at - p0);
  return std::min(room.height, room.slope->knee + (room.height - room.slope->knee) * std::max(0.0, distance) /
                                                      room.slope->reach);
}

std::vector<std::string> floor_kinds() { return {"tiles", "wood", "carpet", "terrazzo", "concrete"}; }

void build_rooms(SceneAssembly& builder) {
  const int count = static_cast<int>(builder.plan().rooms.size());
  for (int r = 0; r < count; ++r) {
    RoomGeometry& geometry = builder.scene().rooms[static_cast<std::size_t>(r)];
    add_horizontal_faces(builder, r, geometry);
    add_walls(builder, r, geometry);
  }
  for (int r = 0; r < count; ++r) add_lamps(builder, r);
}

}  // namespace vsgraphs
