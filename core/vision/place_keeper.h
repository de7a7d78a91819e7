// Keeps the place index at the map's living keyframes: a follower.
#pragma once

#include <memory>

#include "core/map/follower.h"
#include "core/vision/place_index.h"

namespace vsgraphs {

// Brings an index up to a map: adds keyframes that are new to it, removes those that were culled. Linear in the keyframes.
void complete(const Map& map, PlaceIndex& places);

class PlaceKeeper : public Follower {
 public:
  explicit PlaceKeeper(const PlaceIndexOptions& options = {})
      : options_(options), places_(std::make_shared<const PlaceIndex>(options)) {}
  explicit PlaceKeeper(std::shared_ptr<const PlaceIndex> places) : places_(std::move(places)) {}

  // As of the last edit; any thread may keep it.
  const std::shared_ptr<const PlaceIndex>& places() const { return places_; }

  const char* name() const override { return "places"; }
  const char* serves() const override { return "places"; }
  void follow(const Map& before, const MapEdit& edit, const Map& after, const Follower* absorbed) override;
  void gather(const Map& map) override;
  bool adopt(const Follower& known) override;
  std::shared_ptr<Follower> copy() const override { return std::make_shared<PlaceKeeper>(*this); }
  void save(ArchiveWriter& archive, const std::string& section) const override;
  void load(const ArchiveReader& archive, const std::string& section) override;
  Wrong wrong_with(const Map& map) const override;

 private:
  PlaceIndexOptions options_;
  std::shared_ptr<const PlaceIndex> places_;
};

}  // namespace vsgraphs
