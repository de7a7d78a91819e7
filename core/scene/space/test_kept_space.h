// For tests: a map of keyframes with depth whose free space is kept, and what it should be. The world is level already.
#pragma once

#include <gtest/gtest.h>

#include "core/map/levelling.h"
#include "core/map/test_map.h"
#include "core/scene/rooms/test_buildings.h"
#include "core/scene/space/space_keeper.h"

namespace vsgraphs::test {

// Adds up what differs: 0 where the same voxels are known, with the same counts.
inline std::uint64_t difference(const VoxelBlocks& a, const VoxelBlocks& b) {
  std::uint64_t sum = 0;
  const auto apart = [](std::uint32_t x, std::uint32_t y) { return x > y ? x - y : y - x; };
  for (const auto* from : {&a, &b}) {
    const VoxelBlocks& other = from == &a ? b : a;
    for (const VoxelBlocks::Block& block : from->blocks()) {
      const VoxelBlocks::Block* there = other.find(block.origin);
      for (std::size_t i = 0; i < block.voxels.size(); ++i) {
        const Voxel voxel = there ? there->voxels[i] : Voxel{};
        sum += apart(block.voxels[i].passes, voxel.passes) + apart(block.voxels[i].hits, voxel.hits);
      }
    }
  }
  return sum;
}

// The share of the occupied voxels of `a` that have an occupied one of `b` no more than a voxel away.
inline double share_near(const VoxelBlocks& a, const VoxelBlocks& b) {
  int all = 0, near = 0;
  const auto occupied_around = [&](const Eigen::Vector3i& at) {
    for (int i = 0; i < 27; ++i)
      if (b.at(at + Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)).occupied()) return true;
    return false;
  };
  for (const VoxelBlocks::Block& block : a.blocks())
    for (int i = 0; i < static_cast<int>(block.voxels.size()); ++i) {
      if (!block.voxels[static_cast<std::size_t>(i)].occupied()) continue;
      ++all;
      near += occupied_around(block.origin + Eigen::Vector3i(i % 8, i / 8 % 8, i / 64));
    }
  return all ? static_cast<double>(near) / all : 1;
}

// Test buildings stand on whole voxels; beside them, rounding does not decide in which voxel a ray ends.
inline Se3 beside_voxels() { return standing_at(0.0137, 0.0271, 0.0193); }

struct KeptMap {
  explicit KeptMap(const FreeSpaceOptions& options = {}, int max_reintegrations = 4)
      : keeper(std::make_shared<SpaceKeeper>(options, max_reintegrations)) {}

  void edit(std::vector<EditOperation> operations, const Follower* absorbed = nullptr) {
    const Map before = map;
    map.snapshot();  // starts fresh chunks, so that `before` stays what it is
    const MapEdit made{map.version(), std::move(operations)};
    map.apply(made);
    keeper->follow(before, made, map, absorbed);
  }
  KeyframeId add(const Se3& pose, std::shared_ptr<const DepthGrid> depth, KeyframeId stretch = {}) {
    const KeyframeId id = map.keyframes().next_id();
    Keyframe keyframe = keyframe_seeing({}, pose, {});
    keyframe.surface = std::move(depth);
    keyframe.stretch = stretch;
    depths[id] = keyframe.surface;
    edit({AddKeyframe{id, std::move(keyframe)}});
    return id;
  }
  // A walk's keyframes from..to as one stretch.
  KeyframeId add_walk(const TestWalk& walk, std::size_t from, std::size_t to) {
    KeyframeId stretch;
    for (std::size_t i = from; i < to; ++i) {
      const KeyframeId id =
          add(beside_voxels() * walk.poses()[i].level_from_camera, walk.depths()[i], stretch);
      if (i == from) stretch = id;
    }
    return stretch;
  }
  void move_stretch(KeyframeId stretch, const Se3& by) {
    std::vector<EditOperation> moves;
    map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
      if (keyframe.stretch == stretch) moves.emplace_back(MoveKeyframe{id, by * keyframe.world_from_camera});
    });
    edit(std::move(moves));
  }
  void up() { edit({vsgraphs::SetUp{Eigen::Vector3d::UnitZ()}}); }
  void catch_up(bool all = true) { keeper->catch_up(map, all); }

  // All depth there ever was but of what was replaced, carved where the keyframes stand now.
  FreeSpace anew() const {
    FreeSpace space(keeper->options());
    const Se3 level_from_world = levelling(map);
    for (const auto& [id, depth] : depths) {
      const RetiredKeyframe* retired = map.retired_keyframes().find(id);
      if (!retired || retired->replaced) continue;
      space.integrate(id, depth, level_from_world * *map.resolve({id, Se3{}}));
    }
    return space;
  }

  Map map;
  std::shared_ptr<SpaceKeeper> keeper;
  std::map<KeyframeId, std::shared_ptr<const DepthGrid>> depths;
};

}  // namespace vsgraphs::test
