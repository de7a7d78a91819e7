#include "core/vision/place_keeper.h"

#include <algorithm>
#include <set>
#include <variant>

namespace vsgraphs {

namespace {

// Keyframes of which an edit may change whether they live.
std::set<KeyframeId> keyframes_in(const MapEdit& edit) {
  std::set<KeyframeId> found;
  for (const EditOperation& operation : edit.operations) {
    if (const auto* added = std::get_if<AddKeyframe>(&operation)) found.insert(added->id);
    if (const auto* removed = std::get_if<RemoveKeyframe>(&operation)) found.insert(removed->id);
  }
  return found;
}

}  // namespace

void complete(const Map& map, PlaceIndex& places) {
  for (const KeyframeId id : places.keyframes())
    if (!map.keyframes().contains(id)) places.remove(id);
  map.keyframes().for_each(
      [&](KeyframeId id, const Keyframe& keyframe) { places.add(id, *keyframe.features); });
}

void PlaceKeeper::follow(const Map&, const MapEdit& edit, const Map& after, const Follower* absorbed) {
  const auto* other = dynamic_cast<const PlaceKeeper*>(absorbed);
  const std::set<KeyframeId> keyframes = keyframes_in(edit);
  if (keyframes.empty() && !other) return;
  // The smaller of two indices is read again into the larger one.
  const bool theirs = other && other->places_->size() > places_->size();
  PlaceIndex places = theirs ? *other->places_ : *places_;
  for (const KeyframeId id : keyframes) {
    const Keyframe* keyframe = after.keyframes().find(id);
    if (keyframe)
      places.add(id, *keyframe->features);
    else
      places.remove(id);
  }
  if (other) complete(after, places);
  places_ = std::make_shared<const PlaceIndex>(std::move(places));
}

void PlaceKeeper::gather(const Map& map) {
  PlaceIndex places(options_);
  complete(map, places);
  places_ = std::make_shared<const PlaceIndex>(std::move(places));
}

bool PlaceKeeper::adopt(const Follower& known) {
  places_ = dynamic_cast<const PlaceKeeper&>(known).places_;
  return true;
}

void PlaceKeeper::save(ArchiveWriter& archive, const std::string& section) const {
  archive.add(section, *places_);
}

void PlaceKeeper::load(const ArchiveReader& archive, const std::string& section) {
  PlaceIndex places;
  archive.read(section, places);
  places_ = std::make_shared<const PlaceIndex>(std::move(places));
}

Wrong PlaceKeeper::wrong_with(const Map& map) const {
  const auto indexed = places_->keyframes();
  const bool all_live = std::all_of(indexed.begin(), indexed.end(),
                                    [&](KeyframeId id) { return map.keyframes().contains(id); });
  return all_live ? nullptr : "a place index of a keyframe that does not exist";
}

}  // namespace vsgraphs
