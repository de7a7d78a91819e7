// Where in the image a feature lies, coarsely: one of 8 x 8 parts of what the image's features cover.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/map/features.h"

namespace vsgraphs {

class ImageParts {
 public:
  explicit ImageParts(const FeatureSet& features) {
    for (const Feature& f : features.features()) {
      width_ = std::max(width_, f.u);
      height_ = std::max(height_, f.v);
    }
  }
  // 0..63, row by row.
  std::uint32_t of(const Feature& f) const { return 8 * along(f.v, height_) + along(f.u, width_); }
  // A set of parts as bits.
  static std::uint64_t flag(std::uint32_t part) { return std::uint64_t{1} << part; }

 private:
  static std::uint32_t along(float at, float size) {
    return static_cast<std::uint32_t>(std::clamp(8 * at / (size + 1), 0.0F, 7.0F));
  }
  float width_ = 0, height_ = 0;
};

}  // namespace vsgraphs
