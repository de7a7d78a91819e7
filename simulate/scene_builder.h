// Internal to core/simulate: collects the surfaces of a scene while it is being built.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "core/base/rng.h"
#include "simulate/scene.h"

namespace vsgraphs {

// What the faces of one thing share.
struct Tag {
  SceneClass label = SceneClass::none;
  std::uint16_t instance = 0;
  int room = -1;
};

// A turned coordinate frame standing in the world: x to the right of somebody facing the thing's back, y its front, z up.
struct Stand {
  Eigen::Vector3d origin{0, 0, 0};
  Eigen::Vector2d x{1, 0};  // unit; y is x turned left

  Eigen::Vector2d y() const { return {-x.y(), x.x()}; }
  Eigen::Vector3d at(const Eigen::Vector3d& p) const;
  Eigen::Vector3d direction(const Eigen::Vector3d& d) const;
};

// Sides of a box in the order of the masks below.
enum BoxSide : unsigned { front = 1, back = 2, right = 4, left = 8, top = 16, bottom = 32, all_sides = 63 };

class SceneAssembly {
 public:
  explicit SceneAssembly(const Plan& plan) {
    scene_.plan = plan;
    scene_.instances.push_back({});  // 0: nothing
  }

  Scene& scene() { return scene_; }
  Scene take();  // the scene with its materials; the builder is empty afterwards
  const Scene& scene() const { return scene_; }
  const Plan& plan() const { return scene_.plan; }

  // Takes faces added since `begin` along with a mover; they are given in its frame.
  void set_mover(std::size_t begin, int mover);

  Tag add_instance(SceneClass label, int room, const std::string& kind = "", int side = -1, int door = -1);

  // A face from its lower left corner; contours in (s, t) with s, t >= 0. Coverings start at an offset of their own (so
  // that walls do not all start with the same texel); motifs fill `size`.
  Face& add_face(const Tag& tag, const Eigen::Vector3d& origin, const Eigen::Vector3d& s_axis,
                 const Eigen::Vector3d& t_axis, const Eigen::Vector2d& size, std::vector<Polygon2> contours,
                 const Material& material);
  Face& add_rectangle(const Tag& tag, const Eigen::Vector3d& origin, const Eigen::Vector3d& s_axis,
                      const Eigen::Vector3d& t_axis, const Eigen::Vector2d& size, const Material& material);

  // A box in a stand's coordinates; `sides` says which faces exist, `front_material` replaces the front's.
  void add_box(const Tag& tag, const Stand& stand, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
               const Material& material, unsigned sides = all_sides,
               const std::optional<Material>& front_material = std::nullopt);

  int room_index(const std::string& id, const std::string& where) const;  // InputError if there is none

 private:
  Scene scene_;
  MaterialStore materials_;
};

// A rectangle on a wall: `stand` at the foot of the wall's beginning, `low` and `high` in its coordinates, the upper y open.
struct WallSpot {
  int room = 0;
  Stand stand;
  Eigen::Vector3d low, high;
};
// What hangs flat: room and wall as a plan names them, the rectangle's middle and size. Throws InputError, which begins with
// `key`, where it does not fit or hangs across an opening.
WallSpot spot_on_wall(const SceneAssembly& builder, const std::string& key, const std::string& room,
                      int wall_index, const Eigen::Vector2d& centre, const Eigen::Vector2d& size);

// The parts of the work, one file each. They throw InputError naming the plan's field.
void check_plan(const Plan& plan);
void lay_out_rooms(SceneAssembly& builder);    // walls, doors and windows as geometry; no surfaces yet
void build_rooms(SceneAssembly& builder);      // floors, ceilings, walls, skirting, lamps
void build_openings(SceneAssembly& builder);   // doors and windows
void build_furniture(SceneAssembly& builder);  // boxes and stairs
void build_posters(SceneAssembly& builder);
void build_markers(SceneAssembly& builder);
void build_partitions(SceneAssembly& builder);
void build_movers(SceneAssembly& builder);  // people, trolleys, the robot
// Scenery and glass of a window instead of a painted pane. `outline`: of the hole, along the wall and above the floor.
void add_window_view(SceneAssembly& builder, const WindowPlan& plan, const Tag& pane, const Stand& stand,
                     const Opening& outline, double pane_depth);
void add_turning_leaf(SceneAssembly& builder, const DoorLeafPlan& plan, DoorGeometry& door, int index);
// A pane of glass, seen from both sides; `corner` is its lower left one from its front.
void add_pane(SceneAssembly& builder, const Tag& tag, const Eigen::Vector3d& corner,
              const Eigen::Vector3d& s_axis, const Eigen::Vector2d& size);

// Height of a room's ceiling over a place, above the room's floor.
double ceiling_height(const RoomPlan& room, const Eigen::Vector2d& at);
void light_scene(Scene& scene);
CameraPath plan_path(const Scene& scene);  // way-points to a checked path

// Where somebody walking at `at` stands in this room: the floor, or the stairs' slope.
double ground_height(const Plan& plan, int room, const Eigen::Vector2d& at);

}  // namespace vsgraphs
