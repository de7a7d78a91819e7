// Structural elements: keeps the free space that keyframes have looked through, and every few seconds of data time finds
// rooms, floors, doors and places in it and in the classified planes. Proposes; the next window turns proposals into
// factors. After vS-Graphs, "Structural Element Recognition".
#pragma once

#include "core/base/trace.h"
#include "core/map/draft.h"
#include "core/scene/structure.h"
#include "core/scene/surface_keeper.h"

namespace vsgraphs {

struct StructureBuilderOptions {
  double interval_s = 2.0;
  int max_reintegrations = 4;
  FreeSpaceOptions free_space;
  StructureOptions structure;
};

template <typename Visitor>
void describe(StructureBuilderOptions& o, Visitor& field) {
  field("interval_s", o.interval_s, 0.1, 600.0, "rooms are sought this often, in seconds of the recording");
  field("max_reintegrations", o.max_reintegrations, 0, 1000,
        "corrected keyframes whose free space is carved anew per pass; all at the end");
}

class StructureBuilder {
 public:
  explicit StructureBuilder(const StructureBuilderOptions& options)
      : options_(options), free_space_(options.free_space) {}

  bool due(double timestamp_s) const {
    return !last_pass_s_ || timestamp_s >= *last_pass_s_ + options_.interval_s;
  }
  // One pass. `last`: nothing comes after it, so everything that was corrected is carved anew.
  MapEdit propose(const Snapshot& snapshot, const SurfaceKeeper& surfaces, double timestamp_s, bool last,
                  TraceSink* trace);

  // The free space so far.
  const FreeSpace& free_space() const { return free_space_; }
  // Goes on with another map: with a copy of what was carved of it, or (null, or carved at another resolution) from its
  // keyframes' depth at the next pass.
  void switch_to(const FreeSpace* free_space);
  // `map` has taken in another one: carves what was carved there, retired keyframes included, where they stand now.
  void absorb(const Map& map, const FreeSpace& free_space);

  std::size_t free_space_bytes() const { return free_space_.memory_bytes(); }

 private:
  void carve(const Map& map, const Se3& level_from_world, bool last);

  StructureBuilderOptions options_;
  FreeSpace free_space_;
  std::optional<double> last_pass_s_;
};

}  // namespace vsgraphs
