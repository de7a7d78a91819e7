// What surfaces look like. Two families: coverings repeat every `repeat_m` (paint, floors, wood, cardboard), motifs are
// stretched once over the face that carries them (posters, doors, book spines, the view from a window).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "core/base/image.h"
#include "simulate/texture.h"

namespace vsgraphs {

struct Material {
  std::string kind = "paint";  // a name known to `paint_material`
  std::uint64_t seed = 0;      // equal (kind, seed, colour, shape) look equal, wherever they hang
  Rgb colour{200, 200, 200};
  double aspect = 1;  // width over height of the face a motif is made for
};

struct PaintedMaterial {
  Image<Rgb> image;
  double repeat_m = 0;  // side of the square that repeats; 0: a motif
};

// Throws InvariantError for an unknown kind: plans are checked before they get here.
PaintedMaterial paint_material(const Material& material);

// The parts of the table; empty image if the kind is not theirs.
PaintedMaterial paint_covering(const Material& material);
PaintedMaterial paint_print(const Material& material);
PaintedMaterial paint_motif(const Material& material);

// Each distinct material painted once. Ids are indices in order of first use.
class MaterialStore {
 public:
  struct Entry {
    Texture texture;
    double repeat_m;
  };
  int id_of(const Material& material);
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  using Key = std::tuple<std::string, std::uint64_t, int, int>;
  std::map<Key, int> ids_;
  std::vector<Entry> entries_;
};

}  // namespace vsgraphs
