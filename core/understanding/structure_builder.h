// Structural elements: every few seconds of data time finds rooms, floors, doors and places in the free space that keyframes
// have looked through and in the classified planes. Proposes; the next window turns proposals into
// factors. After vS-Graphs, "Structural Element Recognition".
#pragma once

#include "core/base/trace.h"
#include "core/map/draft.h"
#include "core/scene/rooms/structure.h"
#include "core/scene/space/space_keeper.h"
#include "core/scene/surfaces/surface_keeper.h"

namespace vsgraphs {

struct StructureBuilderOptions {
  double interval_s = 2.0;
  int max_reintegrations = 4;
  FreeSpaceOptions free_space;
  StructureOptions structure;
};

template <typename Visitor>
void describe(StructureBuilderOptions& o, Visitor& field) {
  field("interval_s", o.interval_s, 0.1, 600.0,
        "time between two searches for rooms, in seconds of the recording");
  field("max_reintegrations", o.max_reintegrations, 0, 1000,
        "number of corrected keyframes that carve their free space anew per search for rooms; all do at the "
        "end");
}

class StructureBuilder {
 public:
  explicit StructureBuilder(const StructureBuilderOptions& options) : options_(options) {}

  bool due(double timestamp_s) const {
    return !last_pass_s_ || timestamp_s >= *last_pass_s_ + options_.interval_s;
  }
  // One pass over the free space and the surfaces as it has been kept up to now.
  MapEdit propose(const Snapshot& snapshot, const SpaceKeeper& space, const SurfaceKeeper& surfaces,
                  double timestamp_s, TraceSink* trace);
  // Another map is worked on: a pass is due.
  void switch_map() { last_pass_s_.reset(); }

 private:
  StructureBuilderOptions options_;
  std::optional<double> last_pass_s_;
};

}  // namespace vsgraphs
