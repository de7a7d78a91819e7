// The newest maps, for any thread to take.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/loops/loop_tally.h"
#include "core/system/maps/atlas_state.h"

namespace vsgraphs {

struct AtlasCounts {
  int loops = 0;            // closed
  int merges = 0;           // maps joined
  int dropped_maps = 0;     // too small to be kept when a new one began
  bool unadjusted = false;  // the run was stopped before the whole map was adjusted to its last loop
};

// Of places in the map worked on, and in the dormant ones.
struct LoopTallies {
  LoopTally loops, joins;
};

class SnapshotCell {
 public:
  struct Content {
    Snapshot snapshot;          // of the map being worked on
    std::int64_t inserted = 0;  // keyframe requests that are in the maps
    std::int64_t completed =
        0;  // of these, all is done that they bring about, adjustment of the map included
    std::shared_ptr<const PlaceIndex> places;  // of the snapshot's keyframes
    // The other maps, oldest first; never null once something was published.
    std::shared_ptr<const std::vector<MapState>> dormant;
    AtlasCounts counts;
    std::shared_ptr<const LoopTallies> tallies;              // null until a place was compared
    std::shared_ptr<const std::vector<std::string>> faults;  // a line per part that was switched off
  };
  void publish(Content content);
  Content take() const;
  // Waits until at least `count` requests are in (completed), or the cell is closed.
  void wait_for_inserted(std::int64_t count) const;
  void wait_for_completed(std::int64_t count) const;
  // Ends all waiting, now and later.
  void close();

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  Content content_;
  bool closed_ = false;
};

}  // namespace vsgraphs
