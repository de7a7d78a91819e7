// Internal to core/simulate: the kinds of furniture and how each is put together.
#pragma once

#include <optional>
#include <span>

#include "simulate/scene_builder.h"

namespace vsgraphs {

// One piece being built, in its own frame: x to the right of somebody behind it, y to its front, z up; the origin is the
// middle of its footprint.
struct Piece {
  SceneAssembly& builder;
  Tag tag;
  Stand stand;
  double w, d, h;  // half width, half depth, height
  Rgb colour;
  std::uint64_t seed;

  void box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Material& material,
           unsigned sides = all_sides, const std::optional<Material>& front = std::nullopt) {
    builder.add_box(tag, stand, low, high, material, sides, front);
  }
  Material plain(const char* kind = "lacquer") const { return {kind, 7, colour}; }
};

struct FurnitureKind {
  const char* name;
  SceneClass label;
  Rgb colour;  // where the plan gives none
  void (*build)(Piece&);
  double shading = 1;  // see Solid
};

std::span<const FurnitureKind> furniture_table();

// What lies and stands on tables.
void keyboard(Piece& p);
void papers(Piece& p);
void magazine(Piece& p);
void mug(Piece& p);
void pens(Piece& p);
void booklet(Piece& p);
void carton(Piece& p);

}  // namespace vsgraphs
