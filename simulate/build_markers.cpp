// Fiducial markers on walls: a white sheet each, the print in its middle.
#include "simulate/marker_bits.h"
#include "simulate/scene_builder.h"

namespace vsgraphs {
namespace {

void add_marker(SceneAssembly& builder, std::size_t index) {
  constexpr double sheet_m = 0.006;  // thicker than a poster, so that it can hang on one
  const MarkerPlan& plan = builder.plan().markers[index];
  const double sheet = plan.size * (marker_cells + 2) / marker_cells;
  const WallSpot spot = spot_on_wall(builder, "markers[" + std::to_string(index) + "]", plan.room, plan.wall,
                                     {plan.along, plan.z}, {sheet, sheet});
  const Tag tag = builder.add_instance(SceneClass::picture, spot.room, "marker");
  const Eigen::Vector3d front(spot.high.x(), sheet_m, spot.high.z());
  builder.add_box(tag, spot.stand, spot.low, front, {"lacquer", 1, {225, 225, 225}},
                  all_sides & ~BoxSide::back,
                  Material{"marker", static_cast<std::uint64_t>(plan.id), {255, 255, 255}});
  Eigen::Matrix3d axes;  // who reads it sees the wall run from right to left
  axes << spot.stand.direction({-1, 0, 0}), Eigen::Vector3d::UnitZ(), spot.stand.direction({0, 1, 0});
  const Eigen::Vector3d middle = spot.stand.at({plan.along, sheet_m, plan.z});
  builder.scene().markers.push_back({spot.room, Se3(axes, middle), tag.instance});
}

}  // namespace

void build_markers(SceneAssembly& builder) {
  for (std::size_t i = 0; i < builder.plan().markers.size(); ++i) add_marker(builder, i);
}

}  // namespace vsgraphs
