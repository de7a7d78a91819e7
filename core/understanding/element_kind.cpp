#include "core/understanding/element_kind.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

namespace vsgraphs {
namespace {

struct Interval {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double length() const { return high - low; }
  double middle() const { return 0.5 * (low + high); }
};

Eigen::Vector3d across(const Eigen::Vector3d& along) { return Eigen::Vector3d::UnitZ().cross(along); }

}  // namespace

void enclose(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& along, FoundElement& element) {
  Interval width, depth, height;
  for (const Eigen::Vector3d& p : points) {
    width.add(p.dot(along));
    depth.add(p.dot(across(along)));
    height.add(p.z());
  }
  element.along = along;
  element.size_m = {width.length(), depth.length(), height.length()};
  element.centre =
      width.middle() * along + depth.middle() * across(along) + height.middle() * Eigen::Vector3d::UnitZ();
}

namespace {

std::vector<Eigen::Vector3d> corners_of(const FoundElement& element) {
  std::vector<Eigen::Vector3d> corners;
  for (const double w : {-0.5, 0.5})
    for (const double d : {-0.5, 0.5})
      for (const double h : {-0.5, 0.5})
        corners.push_back(element.centre + w * element.size_m.x() * element.along +
                          d * element.size_m.y() * across(element.along) +
                          h * element.size_m.z() * Eigen::Vector3d::UnitZ());
  return corners;
}

// Of the boxes, as laid along the first one's axes; 0 where they touch.
double gap(const FoundElement& a, const FoundElement& b) {
  FoundElement other = b;
  enclose(corners_of(b), a.along, other);
  const Eigen::Vector3d apart = other.centre - a.centre;
  const Eigen::Vector3d between(std::abs(apart.dot(a.along)), std::abs(apart.dot(across(a.along))),
                                std::abs(apart.z()));
  return (between - 0.5 * (a.size_m + other.size_m)).cwiseMax(0.0).norm();
}

template <typename Value>
void unite(std::vector<Value>& all, const std::vector<Value>& more) {
  std::set<Value> united(all.begin(), all.end());
  united.insert(more.begin(), more.end());
  all.assign(united.begin(), united.end());
}

// The larger one's axes are the whole's.
void unite(FoundElement& all, const FoundElement& piece) {
  const bool larger = piece.size_m.x() > all.size_m.x();
  std::vector<Eigen::Vector3d> corners = corners_of(all);
  const std::vector<Eigen::Vector3d> more = corners_of(piece);
  corners.insert(corners.end(), more.begin(), more.end());
  enclose(corners, larger ? piece.along : all.along, all);
  unite(all.planes, piece.planes);
  unite(all.rooms, piece.rooms);
}

std::vector<FoundElement> put_together(std::vector<FoundElement> pieces, double same_within_m) {
  for (std::size_t i = 0; i < pieces.size();) {
    std::size_t other = i + 1;
    while (other < pieces.size() && gap(pieces[i], pieces[other]) >= same_within_m) ++other;
    if (other == pieces.size()) {
      ++i;
      continue;
    }
    unite(pieces[i], pieces[other]);
    pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(other));
    i = 0;  // what has grown may have come near those before it
  }
  return pieces;
}

void number(const ElementKind& kind, std::span<const FoundElement> previous, ElementNumber& next_number,
            std::vector<FoundElement>& elements) {
  std::vector<std::tuple<double, ElementNumber, std::size_t>> pairs;  // (distance, previous, new)
  for (const FoundElement& before : previous) {
    if (before.kind != kind.name) continue;
    for (std::size_t i = 0; i < elements.size(); ++i)
      if (gap(before, elements[i]) < kind.same_within_m)
        pairs.emplace_back((before.centre - elements[i].centre).norm(), before.number, i);
  }
  std::sort(pairs.begin(), pairs.end());
  std::set<ElementNumber> given;
  for (const auto& [distance, number_before, i] : pairs) {
    if (elements[i].number != no_element || given.contains(number_before)) continue;
    elements[i].number = number_before;
    given.insert(number_before);
  }
  for (FoundElement& element : elements)
    if (element.number == no_element) element.number = next_number++;
  std::sort(elements.begin(), elements.end(),
            [](const FoundElement& a, const FoundElement& b) { return a.number < b.number; });
}

}  // namespace

std::vector<ElementKind> sought_kinds(std::span<const ElementKind> kinds, const Map& map,
                                      const SurfaceKeeper& surfaces) {
  bool labelled = false;
  map.planes().for_each([&](PlaneId id, const MappedPlane&) {
    const KnownSurface* known = surfaces.find(id);
    labelled |=
        known && (!known->class_votes().empty() || std::any_of(known->votes().begin(), known->votes().end(),
                                                               [](float weight) { return weight > 0; }));
  });
  std::vector<ElementKind> sought;
  for (const ElementKind& kind : kinds)
    if (labelled || !kind.by_labels) sought.push_back(kind);
  return sought;
}

std::vector<FoundElement> find_elements(std::span<const ElementKind> kinds, const ElementSights& sights,
                                        std::span<const FoundElement> previous, ElementNumber& next_number) {
  std::vector<FoundElement> all;
  for (const ElementKind& kind : kinds) {
    std::vector<FoundElement> elements = put_together(kind.find(sights), kind.same_within_m);
    for (FoundElement& element : elements) element.kind = kind.name;
    number(kind, previous, next_number, elements);
    all.insert(all.end(), elements.begin(), elements.end());
  }
  return all;
}

FoundElement element_of(const ElementSights& sights, PlaneId plane, double inside_m) {
  FoundElement element;
  element.planes = {plane};
  const KnownSurface* known = sights.surfaces.find(plane);
  const AnchoredPlane level =
      sights.map.planes().find(plane)->plane.transformed(sights.structure.level_from_world);
  std::vector<Eigen::Vector3d> points;
  if (known)
    for (const Eigen::Vector3d& p : known->extent().points())
      points.push_back(level.project(sights.structure.level_from_world * p));
  if (points.empty()) return element;
  const Eigen::Vector3d along = level.normal.cross(Eigen::Vector3d::UnitZ());
  if (along.norm() < 0.7) return element;
  enclose(points, along.normalized(), element);
  const Eigen::Vector3d inside = element.centre + inside_m * level.normal;
  for (const FoundRoom& room : sights.structure.rooms) {
    const double above_m = inside.z() - room.ground_m;
    if (above_m > -0.3 && above_m < room.height_m.value_or(3.0) + 0.3 &&
        contains(room.polygon, inside.head<2>()))
      element.rooms.push_back(room.number);
  }
  std::sort(element.rooms.begin(), element.rooms.end());
  return element;
}

}  // namespace vsgraphs
