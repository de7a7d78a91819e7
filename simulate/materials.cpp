#include "simulate/materials.h"

#include <cmath>

#include "core/base/check.h"

namespace vsgraphs {

PaintedMaterial paint_material(const Material& material) {
  PaintedMaterial painted = paint_covering(material);
  if (painted.image.empty()) painted = paint_print(material);
  if (painted.image.empty()) painted = paint_motif(material);
  VSG_INVARIANT(!painted.image.empty());
  return painted;
}

int MaterialStore::id_of(const Material& m) {
  // The shape matters to a motif's layout only coarsely: eighths keep near-equal faces on one texture.
  const Key key{m.kind, m.seed, m.colour.r << 16 | m.colour.g << 8 | m.colour.b,
                static_cast<int>(std::lround(8 * std::log2(m.aspect)))};
  const auto [it, added] = ids_.try_emplace(key, static_cast<int>(entries_.size()));
  if (added) {
    const PaintedMaterial painted = paint_material(m);
    entries_.push_back({Texture(painted.image), painted.repeat_m});
  }
  return it->second;
}

}  // namespace vsgraphs
