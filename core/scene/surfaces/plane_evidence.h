// What rays say about a plane, cell by cell: here they ended on it, there they passed through it to something behind. A
// cabinet's front is passed above its top, a door leaf beside its edge, a table on all sides; a wall only through its
// openings. (Free-space reasoning as in occupancy mapping, Moravec and Elfes, ICRA 1985, reduced to one plane.)
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/camera.h"
#include "core/map/depth_grid.h"
#include "core/scene/surfaces/plane_extent.h"

namespace vsgraphs {

struct CellEvidence {
  std::uint16_t on = 0;       // rays that ended there
  std::uint16_t through = 0;  // rays that passed there and ended behind
  bool operator==(const CellEvidence&) const = default;
};
template <FieldsOf<CellEvidence> T>
void visit_fields(T& v, auto& field) {
  auto& [on, through] = v;
  field(on, through);
}

// Where the rays of one keyframe met a plane; world.
struct MetRays {
  std::vector<Eigen::Vector3d> on, through;
};
// Only rays that come from the side the plane faces count. Cost: the grid's samples, every other one of each row.
MetRays rays_that_meet(const AnchoredPlane& plane, const DepthGrid& grid, const Se3& world_from_camera,
                       const DepthNoise& noise);

class PlaneEvidence {
 public:
  static constexpr double cell_m = PlaneExtent::cell_m;

  static constexpr double max_range_m = 6.0;  // rays that end farther off tell nothing

  PlaneEvidence() = default;
  explicit PlaneEvidence(const PlaneFrame& frame) : frame_(frame) {}

  // Adds the rays of one keyframe that meet the plane within `margin_m` of where it was seen before or is seen now; returns
  // those. `observes_it`: the keyframe found the plane; others tell of it only near where it was seen, because what lies in
  // line with it elsewhere (on the next storey) is another surface.
  MetRays count(const MetRays& rays, bool observes_it);
  // Adds them all.
  void count_all(const MetRays& rays);
  // rays_that_meet() and count().
  void integrate(const AnchoredPlane& plane, const DepthGrid& grid, const Se3& world_from_camera,
                 const DepthNoise& noise, bool observes_it = true);
  // The plane was seen here, by keyframes whose rays may not be told: points (world).
  void expect(const std::vector<Eigen::Vector3d>& points);
  // Takes over what was counted of the same plane elsewhere, each cell from where it lies now.
  void add(const PlaneEvidence& other);
  // Goes along where the plane is moved; no cell changes.
  void set_frame(const PlaneFrame& frame) { frame_ = frame; }

  const PlaneFrame& frame() const { return frame_; }
  const CellGrid<CellEvidence>& cells() const { return cells_; }
  // No ray ended on it yet.
  bool unseen() const { return !seen_; }
  // Seen as surface, and not rather as a hole.
  bool solid(Cell c) const {
    const CellEvidence e = cells_.at(c);
    return e.on >= min_on && e.on > e.through;
  }
  // Rays pass here.
  bool open(Cell c) const {
    const CellEvidence e = cells_.at(c);
    return e.through >= min_through && e.through > e.on;
  }
  // Does the plane stand in the way at this point of it?
  bool solid_at(const Eigen::Vector3d& point) const {
    const Eigen::Vector2d c = frame_.coordinates(point);
    return solid(cell_at(c.x(), c.y(), cell_m));
  }

  // Of one that was read: the box holds only what cells can be.
  bool fits_together() const {
    const auto near = [](int cell) { return cell >= -farthest_cell && cell <= farthest_cell; };
    return near(box_.low.s) && near(box_.low.t) && near(box_.high.s) && near(box_.high.t);
  }

  template <FieldsOf<PlaneEvidence> T>
  friend void visit_fields(T& v, auto& field) {
    field(v.frame_, v.cells_, v.box_.low.s, v.box_.low.t, v.box_.high.s, v.box_.high.t, v.seen_);
  }

 private:
  static constexpr int min_on = 2, min_through = 2;
  static constexpr double margin_m = 1.0;
  static constexpr int own_margin =
      3;  // cells up to which a keyframe that does not observe the plane adds surface

  PlaneFrame frame_;
  CellGrid<CellEvidence> cells_;
  // Bounding box of the cells where it was seen; empty while low > high.
  struct Box {
    Cell low{1, 1}, high{0, 0};
    bool empty() const { return low.s > high.s; }
    void add(Cell c);
    // Within this many cells of it.
    bool near(Cell c, int margin) const {
      return c.s >= low.s - margin && c.s <= high.s + margin && c.t >= low.t - margin &&
             c.t <= high.t + margin;
    }
  };
  Box box_;
  bool seen_ = false;
  void count_on(Cell c);
  std::optional<Cell> cell_of(const Eigen::Vector3d& point) const;
};

}  // namespace vsgraphs
