#include "core/vision/place_segment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/check.h"
#include "core/vision/image_parts.h"

namespace vsgraphs {

namespace {

constexpr std::size_t bucket_count = std::size_t{1} << PlaceSignature::key_bits;

}  // namespace

std::uint32_t PlaceSegment::angle_steps(float angle_rad) {
  constexpr int steps = 1 << angle_bits;
  const auto nearest = std::lround(static_cast<double>(angle_rad) * steps / (2 * std::numbers::pi));
  return static_cast<std::uint32_t>(nearest & (steps - 1));
}

PlaceSegment::PlaceSegment(Content content)
    : keyframes_(std::move(content.keyframes)),
      begin_(bucket_count + 1, 0),
      signatures_(std::move(content.signatures)),
      owners_(std::move(content.owners)) {
  VSG_INVARIANT(signatures_.size() == owners_.size());
  for (const PlaceSignature& signature : signatures_) ++begin_[signature.key() + 1];
  for (std::size_t k = 0; k < bucket_count; ++k) begin_[k + 1] += begin_[k];
}

PlaceSegment::PlaceSegment(KeyframeId keyframe, const FeatureSet& features, int count)
    : keyframes_{keyframe}, begin_(bucket_count + 1, 0) {
  VSG_INVARIANT(keyframe.index < most_keyframes);
  const ImageParts parts(features);
  const int n = std::min(count, features.size());
  for (int i = 0; i < n; ++i) ++begin_[PlaceSignature::of(features.descriptor(i)).key() + 1];
  for (std::size_t k = 0; k < bucket_count; ++k) begin_[k + 1] += begin_[k];
  signatures_.resize(static_cast<std::size_t>(n));
  owners_.resize(signatures_.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (int i = 0; i < n; ++i) {
    const std::uint32_t place = next[PlaceSignature::of(features.descriptor(i)).key()]++;
    signatures_[place] = PlaceSignature::of(features.descriptor(i));
    owners_[place] = Owner::of(keyframe.index, parts.of(features[i]), angle_steps(features[i].angle_rad));
  }
}

PlaceSegment::PlaceSegment(const PlaceSegment& a, const PlaceSegment* b,
                           std::span<const std::uint8_t> removed) {
  add_keyframes(a, removed);
  if (b) add_keyframes(*b, removed);
  begin_.reserve(bucket_count + 1);
  signatures_.reserve(a.size() + (b ? b->size() : 0));
  owners_.reserve(signatures_.capacity());
  for (std::uint32_t key = 0; key < bucket_count; ++key) {
    begin_.push_back(static_cast<std::uint32_t>(signatures_.size()));
    append(a, key, removed);
    if (b) append(*b, key, removed);
  }
  begin_.push_back(static_cast<std::uint32_t>(signatures_.size()));
  signatures_.shrink_to_fit();
  owners_.shrink_to_fit();
}

void PlaceSegment::add_keyframes(const PlaceSegment& from, std::span<const std::uint8_t> removed) {
  for (const KeyframeId id : from.keyframes_) {
    if (!removed[id.index]) keyframes_.push_back(id);
  }
}

void PlaceSegment::append(const PlaceSegment& from, std::uint32_t key,
                          std::span<const std::uint8_t> removed) {
  for (std::uint32_t i = from.begin_[key]; i < from.begin_[key + 1]; ++i) {
    if (removed[from.owners_[i].keyframe()]) continue;
    signatures_.push_back(from.signatures_[i]);
    owners_.push_back(from.owners_[i]);
  }
}

std::size_t PlaceSegment::bytes() const {
  return begin_.size() * sizeof(std::uint32_t) + keyframes_.size() * sizeof(KeyframeId) +
         signatures_.size() * (sizeof(PlaceSignature) + sizeof(Owner));
}

}  // namespace vsgraphs
