#include "core/vision/place_index.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/check.h"

namespace vsgraphs {

namespace {

constexpr std::size_t small_segment = 16;  // keyframes; smaller ones are merged at once
constexpr std::size_t segment_ratio = 4;   // of neighbouring segments' sizes, at least
constexpr int turn_bins = 16;

struct Hit {
  std::uint32_t keyframe;
  int distance;
  std::uint8_t angle;
};

// A flag for the part of what features cover, one of 8 x 8, that a feature lies in.
class ImageParts {
 public:
  explicit ImageParts(const FeatureSet& features) {
    for (const Feature& f : features.features()) {
      width_ = std::max(width_, f.u);
      height_ = std::max(height_, f.v);
    }
  }
  std::uint64_t flag(const Feature& f) const {
    return std::uint64_t{1} << (8 * part(f.v, height_) + part(f.u, width_));
  }

 private:
  static unsigned part(float at, float size) {
    return static_cast<unsigned>(std::clamp(8 * at / (size + 1), 0.0F, 7.0F));
  }
  float width_ = 0, height_ = 0;
};

struct Votes {
  double weight = 0;
  int count = 0;
  int parts = 0;  // of the image, that they come from
};

// Votes per keyframe and turn: a count, by weight, and where in the image they come from.
class Ballot {
 public:
  Ballot(std::size_t keyframes, std::span<const std::uint8_t> removed)
      : removed_(removed), slots_(keyframes), best_(keyframes, no_hit) {}

  // All hits of one feature, in several parts. Only the nearest one in each keyframe counts.
  void add(const Hit& hit) {
    if (removed_[hit.keyframe]) return;
    std::int32_t& best = best_[hit.keyframe];
    if (best == no_hit) {
      best = static_cast<std::int32_t>(hits_.size());
      hits_.push_back(hit);
    } else if (hit.distance < hits_[static_cast<std::size_t>(best)].distance) {
      hits_[static_cast<std::size_t>(best)] = hit;
    }
  }
  void close(std::uint8_t angle, std::uint64_t where, double keyframes) {
    const float weight =
        hits_.empty() ? 0 : static_cast<float>(std::log((keyframes + 1) / static_cast<double>(hits_.size())));
    for (const Hit& hit : hits_) {
      const auto bin = static_cast<std::uint8_t>(hit.angle - angle) / (256 / turn_bins);
      slots_[hit.keyframe].weight[static_cast<std::size_t>(bin)] += weight;
      ++slots_[hit.keyframe].count[static_cast<std::size_t>(bin)];
      slots_[hit.keyframe].seen_in[static_cast<std::size_t>(bin)] |= where;
      best_[hit.keyframe] = no_hit;
    }
    hits_.clear();
  }
  // Of the best three neighbouring turns.
  Votes result(std::size_t keyframe) const {
    Votes best;
    const Slot& slot = slots_[keyframe];
    for (std::size_t b = 0; b < turn_bins; ++b) {
      const std::size_t before = (b + turn_bins - 1) % turn_bins, after = (b + 1) % turn_bins;
      const double weight = slot.weight[before] + slot.weight[b] + slot.weight[after];
      if (weight <= best.weight) continue;
      best.weight = weight;
      best.count = slot.count[before] + slot.count[b] + slot.count[after];
      best.parts = std::popcount(slot.seen_in[before] | slot.seen_in[b] | slot.seen_in[after]);
    }
    return best;
  }

 private:
  static constexpr std::int32_t no_hit = -1;
  struct Slot {
    std::array<float, turn_bins> weight{};
    std::array<std::uint16_t, turn_bins> count{};
    std::array<std::uint64_t, turn_bins> seen_in{};
  };
  std::span<const std::uint8_t> removed_;
  std::vector<Slot> slots_;
  std::vector<std::int32_t> best_;
  std::vector<Hit> hits_;
};

// The buckets one feature has to look into, looked up ahead of time so that memory can be on its way.
class Probes {
 public:
  void gather(const std::vector<std::shared_ptr<const PlaceSegment>>& segments, const Descriptor& wanted) {
    wanted_ = PlaceSignature::of(wanted);
    buckets_.clear();
    for (const auto& segment : segments) {
      gather(*segment, wanted_.key());
      for (int bit = 0; bit < PlaceSignature::key_bits; ++bit) gather(*segment, wanted_.key() ^ (1U << bit));
    }
  }
  void scan(int max_distance, Ballot& ballot) const {
    for (const PlaceSegment::Bucket& bucket : buckets_) {
      for (std::uint32_t i = 0; i < bucket.size; ++i) {
        const int distance = bucket.signatures[i].distance(wanted_);
        if (distance > max_distance) continue;
        const PlaceSegment::Owner owner = bucket.owners[i];
        ballot.add({owner.keyframe(), distance, owner.angle()});
      }
    }
  }

 private:
  void gather(const PlaceSegment& segment, std::uint32_t key) {
    const PlaceSegment::Bucket bucket = segment.bucket(key);
    if (bucket.size == 0) return;
    constexpr std::uint32_t per_line = 64 / sizeof(PlaceSignature);
    for (std::uint32_t i = 0; i < std::min(bucket.size, 8 * per_line); i += per_line)
      __builtin_prefetch(bucket.signatures + i);
    buckets_.push_back(bucket);
  }

  PlaceSignature wanted_;
  std::vector<PlaceSegment::Bucket> buckets_;
};

}  // namespace

void PlaceIndex::add(KeyframeId keyframe, const FeatureSet& features) {
  VSG_INVARIANT(keyframe.valid());
  if (keyframe.index >= ids_.size()) {
    ids_.resize(keyframe.index + 1);
    removed_.resize(keyframe.index + 1, 0);
  }
  if (ids_[keyframe.index].valid()) return;
  ids_[keyframe.index] = keyframe;
  ++size_;
  segments_.push_back(
      std::make_shared<const PlaceSegment>(keyframe, features, options_.features_per_keyframe));
  compact();
}

bool PlaceIndex::restore(std::vector<PlaceSegment::Content> segments) {
  const auto known = [this](std::uint32_t index) { return index < ids_.size() && ids_[index].valid(); };
  if (removed_.size() != ids_.size() || options_.features_per_keyframe < 0) return false;
  size_ = 0;
  for (std::uint32_t i = 0; i < ids_.size(); ++i) {
    if (ids_[i].valid() && ids_[i].index != i) return false;
    if (ids_[i].valid() && removed_[i] == 0) ++size_;
  }
  segments_.clear();
  for (PlaceSegment::Content& content : segments) {
    const auto by_key = [](const PlaceSignature& a, const PlaceSignature& b) { return a.key() < b.key(); };
    const bool fits = content.owners.size() == content.signatures.size() && !content.keyframes.empty() &&
                      std::is_sorted(content.signatures.begin(), content.signatures.end(), by_key) &&
                      std::all_of(content.owners.begin(), content.owners.end(),
                                  [&](auto o) { return known(o.keyframe()); }) &&
                      std::all_of(content.keyframes.begin(), content.keyframes.end(),
                                  [&](auto id) { return known(id.index); });
    if (!fits) return false;
    segments_.push_back(std::make_shared<const PlaceSegment>(std::move(content)));
  }
  return true;
}

void PlaceIndex::compact() {
  while (segments_.size() >= 2) {
    const PlaceSegment& last = *segments_.back();
    const PlaceSegment& before = *segments_[segments_.size() - 2];
    const std::size_t n = last.keyframes().size();
    const bool merge = before.keyframes().size() < small_segment ||
                       (n >= small_segment && before.keyframes().size() < segment_ratio * n);
    if (!merge) return;
    auto merged = std::make_shared<const PlaceSegment>(before, &last, removed_);
    segments_.pop_back();
    segments_.back() = std::move(merged);
  }
}

void PlaceIndex::remove(KeyframeId keyframe) {
  if (!contains(keyframe)) return;
  removed_[keyframe.index] = 1;
  --size_;
  drop_removed();
}

void PlaceIndex::drop_removed() {
  for (auto& segment : segments_) {
    const auto& members = segment->keyframes();
    const auto gone = std::count_if(members.begin(), members.end(),
                                    [this](KeyframeId id) { return removed_[id.index] != 0; });
    if (2 * static_cast<std::size_t>(gone) > members.size())
      segment = std::make_shared<const PlaceSegment>(*segment, nullptr, removed_);
  }
  std::erase_if(segments_, [](const auto& segment) { return segment->keyframes().empty(); });
}

bool PlaceIndex::contains(KeyframeId keyframe) const {
  return keyframe.index < ids_.size() && ids_[keyframe.index] == keyframe && !removed_[keyframe.index];
}

std::vector<KeyframeId> PlaceIndex::keyframes() const {
  std::vector<KeyframeId> present;
  for (const KeyframeId id : ids_) {
    if (id.valid() && !removed_[id.index]) present.push_back(id);
  }
  return present;
}

std::size_t PlaceIndex::bytes() const {
  std::size_t sum = ids_.size() * sizeof(KeyframeId) + removed_.size();
  for (const auto& segment : segments_) sum += segment->bytes();
  return sum;
}

std::vector<PlaceMatch> PlaceIndex::query(const FeatureSet& features, int max_results,
                                          std::span<const std::uint8_t> excluded) const {
  Ballot ballot(ids_.size(), removed_);
  const int asked = std::min(options_.features_per_keyframe, features.size());
  const ImageParts parts(features);
  std::uint64_t asked_in = 0;
  std::array<Probes, 2> probes;
  if (asked > 0) probes[0].gather(segments_, features.descriptor(0));
  for (int i = 0; i < asked; ++i) {
    if (i + 1 < asked) probes[(i + 1) % 2].gather(segments_, features.descriptor(i + 1));
    probes[i % 2].scan(options_.max_distance, ballot);
    const std::uint64_t where = parts.flag(features[i]);
    asked_in |= where;
    ballot.close(PlaceSegment::angle_steps(features[i].angle_rad), where, size_);
  }
  std::vector<PlaceMatch> matches;
  const double most = asked * std::log(size_ + 1.0);
  for (std::size_t k = 0; k < ids_.size(); ++k) {
    if (k < excluded.size() && excluded[k]) continue;
    const Votes votes = ballot.result(k);
    if (votes.weight <= 0) continue;
    const double spread = static_cast<double>(votes.parts) / std::popcount(asked_in);
    matches.push_back({ids_[k], spread * votes.weight / most, votes.count});
  }
  const auto end = matches.begin() + std::min<std::ptrdiff_t>(max_results, std::ssize(matches));
  std::partial_sort(matches.begin(), end, matches.end(), [](const PlaceMatch& a, const PlaceMatch& b) {
    return a.score != b.score ? a.score > b.score : a.keyframe < b.keyframe;
  });
  matches.erase(end, matches.end());
  return matches;
}

}  // namespace vsgraphs
