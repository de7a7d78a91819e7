// A thing of the scene besides rooms, floors and doors: what its kind says (core/understanding/element_kind.h). A plain value in the
// levelled frame (z up, metres), found anew from planes with each pass over the structure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/fields.h"
#include "core/geometry/se3.h"
#include "core/map/ids.h"

namespace vsgraphs {

// Names an element for as long as it is recognised again; never given to another one, of whatever kind.
using ElementNumber = std::uint32_t;
inline constexpr ElementNumber no_element = 0xffffffffu;

struct FoundElement {
  std::string kind;
  ElementNumber number = no_element;
  // Its upright box: the middle, the horizontal unit direction of its width, and width, depth and height.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  std::vector<PlaneId> planes;       // that show it, ascending
  std::vector<std::uint32_t> rooms;  // numbers of the rooms it belongs to, ascending
};
template <FieldsOf<FoundElement> T>
void visit_fields(T& v, auto& field) {
  auto& [kind, number, centre, along, size_m, planes, rooms] = v;
  field(kind, number, centre, along, size_m, planes, rooms);
}

}  // namespace vsgraphs
