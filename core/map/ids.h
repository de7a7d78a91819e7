// Typed generational ids. An id names one thing for ever: when its slot is used again the generation differs, so
// a stale id finds nothing instead of something else.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>

#include "core/base/fields.h"

namespace vsgraphs {

template <typename Tag>
struct Id {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t index = none;
  std::uint32_t generation = 0;

  bool valid() const { return index != none; }
  auto operator<=>(const Id&) const = default;

  template <FieldsOf<Id> T>
  friend void visit_fields(T& v, auto& field) {
    field(v.index, v.generation);
  }
};

using KeyframeId = Id<struct KeyframeTag>;
using LandmarkId = Id<struct LandmarkTag>;
using PlaneId = Id<struct PlaneTag>;

}  // namespace vsgraphs
