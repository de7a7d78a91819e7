#include "core/vision/place_index.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/vision/image_parts.h"

namespace vsgraphs {

namespace {

constexpr std::size_t small_segment = 16;  // keyframes; smaller ones are merged at once
constexpr std::size_t segment_ratio = 4;   // of neighbouring segments' sizes, at least
constexpr int turn_bins = 16;

struct Hit {
  PlaceSegment::Owner owner;
  int distance;
};

struct Votes {
  double weight = 0;
  int count = 0;
  std::uint64_t asked_in = 0, found_in = 0;  // parts of the two images that they come from
};

// Votes per keyframe and turn: a count, by weight, and where in the two images they come from.
class Ballot {
 public:
  Ballot(std::size_t keyframes, std::span<const std::uint8_t> removed, int max_distance)
      : removed_(removed), slots_(keyframes), best_(keyframes, no_hit) {
    // A Gauss bell that has fallen to a seventh where hits end.
    const double sigma = 0.5 * std::max(max_distance, 1);
    for (int d = 0; d <= max_distance; ++d)
      closeness_.push_back(static_cast<float>(std::exp(-d * d / (2 * sigma * sigma))));
    near_ = max_distance * 4 / 5;
  }

  // All hits of one feature, in several parts. Only the nearest one in each keyframe counts.
  void add(const Hit& hit) {
    if (removed_[hit.owner.keyframe()]) return;
    std::int32_t& best = best_[hit.owner.keyframe()];
    if (best == no_hit) {
      best = static_cast<std::int32_t>(hits_.size());
      hits_.push_back(hit);
    } else if (hit.distance < hits_[static_cast<std::size_t>(best)].distance) {
      hits_[static_cast<std::size_t>(best)] = hit;
    }
  }
  void close(std::uint32_t angle, std::uint32_t part, double keyframes) {
    const float weight =
        hits_.empty() ? 0 : static_cast<float>(std::log((keyframes + 1) / static_cast<double>(hits_.size())));
    for (const Hit& hit : hits_) {
      constexpr std::uint32_t steps = 1U << PlaceSegment::angle_bits;
      Bin& bin =
          slots_[hit.owner.keyframe()][((hit.owner.angle() - angle) & (steps - 1)) / (steps / turn_bins)];
      bin.weight += weight * closeness_[static_cast<std::size_t>(hit.distance)];
      ++bin.count;
      // Chance hits are far off, and all over the image.
      if (hit.distance <= near_) {
        bin.asked_in |= ImageParts::flag(part);
        bin.found_in |= ImageParts::flag(hit.owner.part());
      }
      best_[hit.owner.keyframe()] = no_hit;
    }
    hits_.clear();
  }
  // Of the best three neighbouring turns.
  Votes result(std::size_t keyframe) const {
    Votes best;
    const auto& slot = slots_[keyframe];
    for (std::size_t b = 0; b < turn_bins; ++b) {
      const Bin &before = slot[(b + turn_bins - 1) % turn_bins], &here = slot[b],
                &after = slot[(b + 1) % turn_bins];
      const double weight = before.weight + here.weight + after.weight;
      if (weight <= best.weight) continue;
      best = {weight, before.count + here.count + after.count,
              before.asked_in | here.asked_in | after.asked_in,
              before.found_in | here.found_in | after.found_in};
    }
    return best;
  }

 private:
  static constexpr std::int32_t no_hit = -1;
  struct Bin {
    float weight = 0;
    std::uint16_t count = 0;
    std::uint64_t asked_in = 0, found_in = 0;
  };
  std::span<const std::uint8_t> removed_;
  std::vector<std::array<Bin, turn_bins>> slots_;
  std::vector<std::int32_t> best_;
  std::vector<Hit> hits_;
  std::vector<float> closeness_;  // what a hit at that distance is worth
  int near_ = 0;                  // distance up to which a hit says where in the image
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
        ballot.add({bucket.owners[i], distance});
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

double share_of(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(std::popcount(part)) / std::popcount(whole);
}

}  // namespace

void PlaceIndex::add(KeyframeId keyframe, const FeatureSet& features) {
  VSG_INVARIANT(keyframe.valid());
  if (keyframe.index >= ids_.size()) {
    ids_.resize(keyframe.index + 1);
    removed_.resize(keyframe.index + 1, 0);
  }
  if (ids_[keyframe.index].valid()) return;
  ids_[keyframe.index] = keyframe;
  covered_.resize(ids_.size());
  const ImageParts parts(features);
  for (int i = 0; i < std::min(options_.features_per_keyframe, features.size()); ++i)
    covered_[keyframe.index] |= ImageParts::flag(parts.of(features[i]));
  ++size_;
  segments_.push_back(
      std::make_shared<const PlaceSegment>(keyframe, features, options_.features_per_keyframe));
  compact();
}

bool PlaceIndex::restore(std::vector<PlaceSegment::Content> segments) {
  const auto known = [this](std::uint32_t index) { return index < ids_.size() && ids_[index].valid(); };
  if (removed_.size() != ids_.size() || covered_.size() != ids_.size() ||
      options_.features_per_keyframe < 0 || options_.max_distance < 0 ||
      options_.max_distance > PlaceSignature::bits)
    return false;
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
                                  [&](auto id) { return known(id.index) && ids_[id.index] == id; });
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
  std::size_t sum = ids_.size() * (sizeof(KeyframeId) + sizeof(covered_[0])) + removed_.size();
  for (const auto& segment : segments_) sum += segment->bytes();
  return sum;
}

std::vector<PlaceMatch> PlaceIndex::query(const FeatureSet& features, int max_results,
                                          std::span<const std::uint8_t> excluded) const {
  Ballot ballot(ids_.size(), removed_, options_.max_distance);
  const int asked = std::min(options_.features_per_keyframe, features.size());
  const ImageParts parts(features);
  std::uint64_t asked_in = 0;
  std::array<Probes, 2> probes;
  if (asked > 0) probes[0].gather(segments_, features.descriptor(0));
  for (int i = 0; i < asked; ++i) {
    if (i + 1 < asked) probes[(i + 1) % 2].gather(segments_, features.descriptor(i + 1));
    probes[i % 2].scan(options_.max_distance, ballot);
    const std::uint32_t part = parts.of(features[i]);
    asked_in |= ImageParts::flag(part);
    ballot.close(PlaceSegment::angle_steps(features[i].angle_rad), part, size_);
  }
  std::vector<PlaceMatch> matches;
  const double most = asked * std::log(size_ + 1.0);
  for (std::size_t k = 0; k < ids_.size(); ++k) {
    if (k < excluded.size() && excluded[k]) continue;
    const Votes votes = ballot.result(k);
    if (votes.weight <= 0) continue;
    const double spread =
        std::sqrt(share_of(votes.asked_in, asked_in) * share_of(votes.found_in, covered_[k]));
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
