// The features of one image: what the extractor found, with depth, and a grid to find them by place.
// Immutable once built; shared between the frame, its keyframe and every snapshot.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/fields.h"
#include "core/base/image.h"

namespace vsgraphs {

// 256 bits of ORB (Rublee et al., ICCV 2011).
struct Descriptor {
  std::array<std::uint64_t, 4> words{};
  bool operator==(const Descriptor&) const = default;
};
template <FieldsOf<Descriptor> T>
void visit_fields(T& v, auto& field) {
  auto& [words] = v;
  field(words);
}

// Hamming distance, 0..256.
inline int hamming(const Descriptor& a, const Descriptor& b) {
  int bits = 0;
  for (int i = 0; i < 4; ++i) bits += std::popcount(a.words[i] ^ b.words[i]);
  return bits;
}

struct Feature {
  float u = 0, v = 0;      // undistorted px, level-0 scale
  float depth_m = 0;       // along the optical axis; 0 where there is no trustworthy reading
  float angle_rad = 0;     // orientation of the patch, -pi..pi
  std::uint8_t level = 0;  // pyramid level it was found at
  Rgb colour;
  bool has_depth() const { return depth_m > 0; }
};
template <FieldsOf<Feature> T>
void visit_fields(T& feature, auto& field) {
  auto& [u, v, depth_m, angle_rad, level, colour] = feature;
  field(u, v, depth_m, angle_rad, level, colour);
}

class FeatureSet {
 public:
  FeatureSet() = default;
  // Takes features and their descriptors (same length, same order); image size in px sets the grid.
  FeatureSet(std::vector<Feature> features, std::vector<Descriptor> descriptors, int width, int height);

  int size() const { return static_cast<int>(features_.size()); }
  const Feature& operator[](int i) const { return features_[static_cast<std::size_t>(i)]; }
  const Descriptor& descriptor(int i) const { return descriptors_[static_cast<std::size_t>(i)]; }
  const std::vector<Feature>& features() const { return features_; }
  const std::vector<Descriptor>& descriptors() const { return descriptors_; }

  // Appends to `out` (not cleared) the indices of features within a square of half-side `radius_px` around
  // (u, v) at levels min_level..max_level, in grid order (row by row of cells, ascending index within a cell).
  void in_area(float u, float v, float radius_px, int min_level, int max_level, std::vector<int>& out) const;

  template <FieldsOf<FeatureSet> T>
  friend void visit_fields(T& v, auto& field) {
    field(v.features_, v.descriptors_, v.columns_, v.rows_);
    if constexpr (std::remove_reference_t<decltype(field)>::reads) {
      field.require(v.consistent(), "features that do not fit together");
      v = FeatureSet(std::move(v.features_), std::move(v.descriptors_), v.columns_ * cell_px,
                     v.rows_ * cell_px);
    }
  }

 private:
  static constexpr int cell_px = 16;
  // Whether the constructor can take what was read.
  bool consistent() const;
  int column(float u) const;
  int row(float v) const;

  std::vector<Feature> features_;
  std::vector<Descriptor> descriptors_;
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> cell_begin_;  // columns*rows+1 offsets into cell_items_
  std::vector<std::uint16_t> cell_items_;
};
template <>
inline constexpr const char* shared_name<FeatureSet> = "features";

}  // namespace vsgraphs
