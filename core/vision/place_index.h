// Which keyframes show the place an image shows: an index over binary descriptors that needs no vocabulary and grows with
// the map. For loop closing and relocalisation.
//
// Look-up is multi-probe locality-sensitive hashing (Lv et al., VLDB 2007) on 16 descriptor bits: the bucket of a feature
// and the 16 one bit away hold about 0.026 % of all features and, where a bit flips in one view of eight, a third of
// the matching ones; the distance over half a descriptor decides. A feature's vote is worth the less the more keyframes it
// is found in (inverse document frequency, Sivic and Zisserman, ICCV 2003), counted by how far it is turned, as a camera
// turns all features alike (weak geometric consistency, Jegou, Douze, Schmid, ECCV 2008), and by how near the two descriptors
// are. Votes from all over both images count more than as many from one poster, which may hang in two rooms.
//
// Storage is a few immutable segments that are merged as they grow (the logarithmic method of Bentley and Saxe, 1980):
// copies share them, so the owner hands out a copy per snapshot and any thread queries it while the owner goes on.
// Look-alike places score alike: what comes out is a candidate until geometry has been asked.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/fields.h"
#include "core/base/options.h"
#include "core/map/features.h"
#include "core/map/ids.h"
#include "core/vision/place_segment.h"

namespace vsgraphs {

struct PlaceIndexOptions {
  int features_per_keyframe = 600;
  int max_distance = 25;
};
template <FieldsOf<PlaceIndexOptions> T>
void visit_fields(T& v, auto& field) {
  auto& [features_per_keyframe, max_distance] = v;
  field(features_per_keyframe, max_distance);
}

template <typename Visitor>
void describe(PlaceIndexOptions& o, Visitor& field) {
  field("features_per_keyframe", o.features_per_keyframe, 50, 20000,
        "number of a keyframe's strongest features that the place index keeps");
  field("max_distance", o.max_distance, 0, 64,
        "largest number of the 128 descriptor bits in which two features of one place may differ");
}

struct PlaceMatch {
  KeyframeId keyframe;
  // 0..1: 1 if every feature asked for were found, bit for bit, in this keyframe alone; less where votes are in one place.
  double score = 0;
  int votes = 0;  // features found in it, turned alike
};

class PlaceIndex {
 public:
  explicit PlaceIndex(const PlaceIndexOptions& options = {}) : options_(options) {}

  // Does nothing if it is in or ever was: ids of keyframes name one thing for ever. Amortised cost below 1 ms at 2,000
  // keyframes; a call in a thousand merges most of the index (30 ms). 20 bytes per feature kept (12 kB per
  // keyframe) and 0.3 MB of tables per segment, of which there are five or so.
  void add(KeyframeId keyframe, const FeatureSet& features);
  // Does nothing if it is not in. Takes effect at once; the memory comes back with a later merge.
  void remove(KeyframeId keyframe);

  bool contains(KeyframeId keyframe) const;
  int size() const { return size_; }          // keyframes
  std::vector<KeyframeId> keyframes() const;  // in the order of their indices
  std::size_t bytes() const;

  // The `max_results` most similar keyframes, best first (ties: lower index). `excluded`: a flag per keyframe index, nonzero
  // ones are left out of the results (but still make a look common); indices beyond its end are not excluded.
  // Any thread, while no other writes this copy. 2 to 3 ms for 2,000 keyframes with 600 features kept of each, and linear in both.
  std::vector<PlaceMatch> query(const FeatureSet& features, int max_results,
                                std::span<const std::uint8_t> excluded = {}) const;

  // Declares its content to an archive; what it reads is checked.
  template <FieldsOf<PlaceIndex> T>
  friend void visit_fields(T& v, auto& field) {
    std::vector<PlaceSegment::Content> segments;
    for (const auto& segment : v.segments_) segments.push_back(segment->content());
    field(v.options_, v.ids_, v.removed_, v.covered_, segments);
    if constexpr (std::remove_reference_t<decltype(field)>::reads)
      field.require(v.restore(std::move(segments)), "a place index that does not fit together");
  }

 private:
  // Takes over segments that were read, after ids and removals; false if the one does not fit the other.
  bool restore(std::vector<PlaceSegment::Content> segments);
  void compact();
  void drop_removed();

  PlaceIndexOptions options_;
  std::vector<std::shared_ptr<const PlaceSegment>> segments_;  // oldest and largest first
  std::vector<KeyframeId> ids_;                                // by keyframe index; invalid: never added
  std::vector<std::uint8_t> removed_;                          // by keyframe index
  std::vector<std::uint64_t> covered_;  // likewise; parts of the image that its features lie in
  int size_ = 0;
};

}  // namespace vsgraphs
