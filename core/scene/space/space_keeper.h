// The free space of a map, which follows the map's edits. What the keyframes of one stretch saw is one grid of voxels; a grid
// stays as it is when a correction moves its stretch, and is only put elsewhere in the whole in which rooms are sought.
//
// The whole stands in the levelled frame (z up, metres). A grid is carved where its keyframes stand by then, so that it stands in
// the whole as it is until a loop, an adjustment or another `up` moves them by more than the options tolerate.
// Not thread-safe.
#pragma once

#include <set>

#include "core/base/copy_on_write.h"
#include "core/map/follower.h"
#include "core/scene/space/space_placement.h"
#include "core/scene/space/space_sum.h"
#include "core/scene/space/space_view.h"

namespace vsgraphs {

class SpaceKeeper final : public Follower {
 public:
  // The grid of a stretch, and where it stands. Copies of the keeper share it until one of them changes it.
  struct Part {
    CopyOnWrite<FreeSpace> space{FreeSpace(FreeSpaceOptions{})};
    Se3 level_from_grid;
    // Not saved:
    bool summed = false;           // the whole has it as it is
    std::vector<BlockKey> covers;  // blocks of the whole that it was last added to
    std::set<KeyframeId> held_by;  // stretches whose keyframes its views are anchored to
    bool to_let_go = false;        // views may be gone that still have depth

    template <FieldsOf<Part> T>
    friend void visit_fields(T& v, auto& field) {
      field(v.space, v.level_from_grid);
    }
  };
  // What a call of catch_up() did; what it cost is proportional to this.
  struct Work {
    int carved = 0;   // keyframes, the first time or again
    int checked = 0;  // keyframes asked where they stand now
    int summed = 0;   // blocks of the whole
  };

  SpaceKeeper(const FreeSpaceOptions& options, int max_reintegrations)
      : options_(options), max_reintegrations_(max_reintegrations) {}

  const char* name() const override { return "free_space"; }
  const char* serves() const override { return "rooms"; }
  // Notes what has changed; takes the grids of an absorbed map over as they are.
  void follow(const Map& before, const MapEdit& edit, const Map& after, const Follower* absorbed) override;
  // Before each search for rooms. Carves new keyframes (about 2 ms each), takes those out that others replace, puts grids where
  // their stretches stand now, and carves those keyframes again that have moved within their stretch: those that moved most, at most
  // max_reintegrations, or all. Keyframes that are gone let go of their depth once the map goes on in another stretch. Does nothing
  // before the map knows which way is up.
  void catch_up(const Map& map, bool all) override;
  // From the living keyframes, with the next catch_up().
  void gather(const Map& map) override;
  bool adopt(const Follower& known) override;

  std::shared_ptr<Follower> copy() const override { return std::make_shared<SpaceKeeper>(*this); }
  void save(ArchiveWriter& archive, const std::string& section) const override;
  // With the options it was saved with. Before format 3 a section is one grid of the whole map; it goes on being one.
  void load(const ArchiveReader& archive, const std::string& section) override;
  Wrong wrong_with(const Map& map) const override;
  // Goes on with other options. If voxels or reach are others, what is known is gathered anew with the next catch_up().
  void use(const FreeSpaceOptions& options, int max_reintegrations);

  // The whole, as it was after the last catch_up().
  const VoxelBlocks& voxels() const { return *whole_; }
  SpaceView view() const;
  const std::map<KeyframeId, Part>& parts() const { return parts_; }  // by stretch
  const FreeSpaceOptions& options() const { return options_; }
  const Work& last_work() const { return work_; }
  std::size_t memory_bytes() const;
  // A line for the user where keyframes were left out because max_blocks was reached; empty: none were.
  std::string warning() const override;

 private:
  struct Moved;

  void take_over(const Map& other, const SpaceKeeper* absorbed);
  void clear();
  void find_new(const Map& map);
  void forget_replaced();
  void put_in_place(const Map& map, const Se3& level_from_world, bool all);
  std::vector<CarvedView> look_at(const Map& map, const Se3& level_from_world, Part& part);
  // Its grid, to be carved.
  FreeSpace& grid_of(Part& part);
  void carve_new(const Map& map, const Se3& level_from_world);
  void let_go(const Map& map);
  void sum();
  bool is_noted(KeyframeId stretch, const Part& part) const;
  bool knows(KeyframeId keyframe) const;
  bool is_full() const;

  FreeSpaceOptions options_;
  int max_reintegrations_;
  std::map<KeyframeId, Part> parts_;
  CopyOnWrite<VoxelBlocks> whole_;
  // What waits for the next catch_up().
  std::set<KeyframeId> new_, replaced_;
  std::set<KeyframeId> moved_;  // stretches
  bool all_moved_ = false;
  bool look_for_new_ = false;   // among all living keyframes
  std::vector<BlockKey> left_;  // of the whole, by parts that are no more
  int refused_ = 0;
  Work work_;
};

}  // namespace vsgraphs
