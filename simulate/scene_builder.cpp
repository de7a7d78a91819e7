#include "simulate/scene_builder.h"

#include <cmath>
#include <utility>

#include "core/base/check.h"

namespace vsgraphs {

Eigen::Vector3d Stand::at(const Eigen::Vector3d& p) const { return origin + direction(p); }

Eigen::Vector3d Stand::direction(const Eigen::Vector3d& d) const {
  const Eigen::Vector2d xy = d.x() * x + d.y() * y();
  return {xy.x(), xy.y(), d.z()};
}

Tag SceneAssembly::add_instance(SceneClass label, int room, const std::string& kind, int side, int door) {
  VSG_INVARIANT(scene_.instances.size() < 65535);
  const auto id = static_cast<std::uint16_t>(scene_.instances.size());
  const std::string room_id = room < 0 ? "" : plan().rooms[static_cast<std::size_t>(room)].id;
  scene_.instances.push_back({label, room_id, kind, side, door});
  return {label, id, room};
}

void SceneAssembly::set_mover(std::size_t begin, int mover) {
  for (std::size_t i = begin; i < scene_.faces.size(); ++i)
    scene_.faces[i].mover = mover, scene_.faces[i].room = -1;
}

Scene SceneAssembly::take() {
  scene_.materials = materials_.entries();
  for (std::size_t i = 0; i < scene_.faces.size(); ++i) {
    if (scene_.faces[i].optics == Optics::mirror) scene_.mirrors.push_back(static_cast<int>(i));
    if (scene_.faces[i].optics == Optics::glass) scene_.panes.push_back(static_cast<int>(i));
  }
  require_input(scene_.mirrors.size() <= 200, "posters: at most 200 mirrors");
  return std::move(scene_);
}

namespace {

Eigen::Vector2d offset_for(const Face& face) {
  // From the place in the world, so that it does not depend on the order of construction.
  const auto fraction = [](double x) { return x - std::floor(x); };
  return {fraction(0.37 * face.origin.x() + 0.73 * face.origin.y()),
          fraction(0.53 * face.origin.z() + 0.19 * face.origin.x())};
}

}  // namespace

Face& SceneAssembly::add_face(const Tag& tag, const Eigen::Vector3d& origin, const Eigen::Vector3d& s_axis,
                              const Eigen::Vector3d& t_axis, const Eigen::Vector2d& size,
                              std::vector<Polygon2> contours, const Material& material) {
  Material shaped = material;
  shaped.aspect = size.x() / size.y();
  Face face;
  face.origin = origin, face.s_axis = s_axis, face.t_axis = t_axis;
  face.contours = std::move(contours);
  face.size = size;
  face.label = tag.label, face.instance = tag.instance, face.room = tag.room;
  face.material = materials_.id_of(shaped);
  const double repeat = materials_.entries()[static_cast<std::size_t>(face.material)].repeat_m;
  if (repeat > 0) {
    face.repeats_per_m = {1 / repeat, 1 / repeat};
    face.texture_offset = offset_for(face);
  } else {
    face.repeats_per_m = size.cwiseInverse();
  }
  scene_.faces.push_back(std::move(face));
  return scene_.faces.back();
}

Face& SceneAssembly::add_rectangle(const Tag& tag, const Eigen::Vector3d& origin,
                                   const Eigen::Vector3d& s_axis, const Eigen::Vector3d& t_axis,
                                   const Eigen::Vector2d& size, const Material& material) {
  const Polygon2 outline{{0, 0}, {size.x(), 0}, size, {0, size.y()}};
  return add_face(tag, origin, s_axis, t_axis, size, {outline}, material);
}

void SceneAssembly::add_box(const Tag& tag, const Stand& stand, const Eigen::Vector3d& low,
                            const Eigen::Vector3d& high, const Material& material, unsigned sides,
                            const std::optional<Material>& front_material) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  struct Side {
    BoxSide mask;
    Eigen::Vector3d corner, s, t;  // lower left corner seen from outside
  };
  const Side table[] = {{BoxSide::front, {high.x(), high.y(), low.z()}, -x, z},
                        {BoxSide::back, low, x, z},
                        {BoxSide::right, {high.x(), low.y(), low.z()}, y, z},
                        {BoxSide::left, {low.x(), high.y(), low.z()}, -y, z},
                        {BoxSide::top, {low.x(), low.y(), high.z()}, x, y},
                        {BoxSide::bottom, {low.x(), high.y(), low.z()}, x, -y}};
  const Eigen::Vector3d extent = high - low;
  for (const Side& side : table) {
    if (!(sides & side.mask)) continue;
    const Eigen::Vector2d size(std::abs(side.s.dot(extent)), std::abs(side.t.dot(extent)));
    const bool use_front = side.mask == BoxSide::front && front_material;
    add_rectangle(tag, stand.at(side.corner), stand.direction(side.s), stand.direction(side.t), size,
                  use_front ? *front_material : material);
  }
}

int SceneAssembly::room_index(const std::string& id, const std::string& where) const {
  for (std::size_t i = 0; i < plan().rooms.size(); ++i)
    if (plan().rooms[i].id == id) return static_cast<int>(i);
  throw InputError(where + ": there is no room \"" + id + "\"");
}

Scene build_scene(const Plan& plan) {
  check_plan(plan);
  SceneAssembly builder(plan);
  lay_out_rooms(builder);
  build_rooms(builder);
  build_openings(builder);
  build_furniture(builder);
  build_posters(builder);
  build_markers(builder);  // these last: plans without any stay as they were
  build_partitions(builder);
  build_movers(builder);
  Scene scene = builder.take();
  light_scene(scene);
  scene.path = plan_path(scene);
  return scene;
}

}  // namespace vsgraphs
