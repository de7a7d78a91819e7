// One immutable run of the place index: signatures of some keyframes' features, sorted by their first 16 bits.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/fields.h"
#include "core/map/features.h"
#include "core/map/ids.h"

namespace vsgraphs {

// The first half of a descriptor, which says most of what the whole says: the learnt pattern's comparisons stand in the
// order in which they were chosen, those that flip least and repeat each other least first (learn_brief_pattern.py).
struct PlaceSignature {
  std::uint64_t low = 0, high = 0;

  static PlaceSignature of(const Descriptor& d) { return {d.words[0], d.words[1]}; }
  static constexpr int key_bits = 16, bits = 128;
  std::uint32_t key() const { return static_cast<std::uint32_t>(low & 0xffff); }
  int distance(const PlaceSignature& other) const {
    return std::popcount(low ^ other.low) + std::popcount(high ^ other.high);
  }
};
template <FieldsOf<PlaceSignature> T>
void visit_fields(T& v, auto& field) {
  auto& [low, high] = v;
  field(low, high);
}

class PlaceSegment {
 public:
  static constexpr std::uint32_t angle_bits = 6, part_bits = 6;
  static constexpr std::uint32_t most_keyframes = 1U << (32 - part_bits - angle_bits);
  // 64 to the full turn.
  static std::uint32_t angle_steps(float angle_rad);

  // Whose feature it is, where in its image, and how it was turned: 20 bits of keyframe index, 6 of part, 6 of angle.
  struct Owner {
    std::uint32_t packed = 0;
    static Owner of(std::uint32_t keyframe, std::uint32_t part, std::uint32_t angle) {
      return {(keyframe << part_bits | part) << angle_bits | angle};
    }
    std::uint32_t keyframe() const { return packed >> (part_bits + angle_bits); }
    std::uint32_t part() const { return packed >> angle_bits & ((1U << part_bits) - 1); }
    std::uint32_t angle() const { return packed & ((1U << angle_bits) - 1); }

    template <FieldsOf<Owner> T>
    friend void visit_fields(T& v, auto& field) {
      field(v.packed);
    }
  };

  // What it is made from: as many owners as signatures, in the order of the signatures' keys.
  struct Content {
    std::vector<KeyframeId> keyframes;
    std::vector<PlaceSignature> signatures;
    std::vector<Owner> owners;
  };
  explicit PlaceSegment(Content content);
  Content content() const { return {keyframes_, signatures_, owners_}; }

  // Of one keyframe's first `count` features.
  PlaceSegment(KeyframeId keyframe, const FeatureSet& features, int count);
  // Of two or one (`b` null): everything but the features of keyframes whose flag in `removed` is set.
  PlaceSegment(const PlaceSegment& a, const PlaceSegment* b, std::span<const std::uint8_t> removed);

  const std::vector<KeyframeId>& keyframes() const { return keyframes_; }
  std::size_t size() const { return signatures_.size(); }
  struct Bucket {
    const PlaceSignature* signatures;
    const Owner* owners;
    std::uint32_t size;
  };
  Bucket bucket(std::uint32_t key) const {
    const std::uint32_t begin = begin_[key];
    return {signatures_.data() + begin, owners_.data() + begin, begin_[key + 1] - begin};
  }
  std::size_t bytes() const;

 private:
  void add_keyframes(const PlaceSegment& from, std::span<const std::uint8_t> removed);
  void append(const PlaceSegment& from, std::uint32_t key, std::span<const std::uint8_t> removed);

  std::vector<KeyframeId> keyframes_;
  std::vector<std::uint32_t> begin_;  // per key, and the end
  std::vector<PlaceSignature> signatures_;
  std::vector<Owner> owners_;
};

template <FieldsOf<PlaceSegment::Content> T>
void visit_fields(T& v, auto& field) {
  auto& [keyframes, signatures, owners] = v;
  field(keyframes, signatures, owners);
}

}  // namespace vsgraphs
