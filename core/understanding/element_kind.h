// Kinds of elements: what hangs, stands or lies in the rooms and is known by its planes. A kind is described once, in a file of its own
// that element_kinds.cpp lists; archives, edits, the Python side and its files take elements of any kind.
//
// How an element is carried: its planes are moved with the keyframes that see them (map/carry.h), and it is found anew from them. Which
// factors it takes: those of its planes. How two merge: boxes no farther apart than the kind says are one thing.
#pragma once

#include <span>
#include <vector>

#include "core/map/element.h"
#include "core/map/map.h"
#include "core/scene/surfaces/surface_keeper.h"

namespace vsgraphs {

// What elements are found in. `structure`: of the same pass, with its rooms; the levelled frame is its own.
struct ElementSights {
  const Map& map;
  const SurfaceKeeper& surfaces;
  const FoundStructure& structure;
};

struct ElementKind {
  const char* name;      // singular, as in files: "shelf"
  double same_within_m;  // boxes with a smaller gap are one element, within a pass and from one to the next
  bool by_labels;        // known by what a segmenter says: not sought where none has said anything
  // Pieces of such elements; their kind and number are set, and pieces of one thing put together, by find_elements().
  std::vector<FoundElement> (*find)(const ElementSights& sights);
};

std::span<const ElementKind> element_kinds();

// Those of the kinds that can be sought in what was seen.
std::vector<ElementKind> sought_kinds(std::span<const ElementKind> kinds, const Map& map,
                                      const SurfaceKeeper& surfaces);

// All elements of these kinds, in their order and ascending by number. `previous`: those of the pass before, whose numbers are kept;
// `next_number`: the first that was never given, moved on. Cost: the planes' extents of the pieces, some ms for a building.
std::vector<FoundElement> find_elements(std::span<const ElementKind> kinds, const ElementSights& sights,
                                        std::span<const FoundElement> previous, ElementNumber& next_number);

// Sets the element's box to the one around the points, levelled, that lies along `along` (unit, horizontal).
void enclose(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& along, FoundElement& element);

// An element of one upright plane: the box of where it was seen, along the plane. Without size where nothing was seen, or the plane
// is level. The rooms are those that `inside_m` in front of it lies in.
FoundElement element_of(const ElementSights& sights, PlaneId plane, double inside_m);

}  // namespace vsgraphs
