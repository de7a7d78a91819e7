#include "core/loops/loop_closer.h"

#include <algorithm>
#include <numbers>

#include "core/matching/landmark_fusion.h"

namespace vsgraphs {

namespace {

constexpr double rad_per_deg = std::numbers::pi / 180.0;

// Per keyframe index: what cannot be the other end of a loop with `keyframe`.
std::vector<std::uint8_t> too_close(const Map& map, KeyframeId keyframe, int min_gap) {
  constexpr int min_shared = 15;
  std::vector<std::uint8_t> flags(map.keyframes().index_bound(), 0);
  int newer = 0;
  for (std::uint32_t index = map.keyframes().index_bound(); index-- > 0;) {
    if (!map.keyframes().at_index(index).valid()) continue;
    if (index >= keyframe.index || newer++ < min_gap) flags[index] = 1;
  }
  for (const auto& [id, shared] : map.covisible(keyframe, min_shared)) flags[id.index] = 1;
  return flags;
}

std::vector<KeyframeId> without(std::vector<KeyframeId> keyframes, const std::vector<KeyframeId>& others) {
  std::erase_if(keyframes, [&others](KeyframeId id) {
    return std::find(others.begin(), others.end(), id) != others.end();
  });
  return keyframes;
}

}  // namespace

const char* to_string(LoopVerdict verdict) {
  static constexpr const char* names[] = {
      "none similar",  "not aligned",         "unsupported",  "tilted", "surfaces disagree",
      "through walls", "neighbours disagree", "beyond drift", "joined", "closed"};
  return names[static_cast<std::size_t>(verdict)];
}

LoopCloser::LoopCloser(const LoopCloserOptions& options, const Camera& camera, const ScalePyramid& pyramid,
                       std::uint64_t seed)
    : options_(options),
      camera_(camera),
      pyramid_(pyramid),
      aligner_(options.alignment, camera, pyramid),
      seed_(seed) {}

std::optional<MapEdit> LoopCloser::close(KeyframeId keyframe, const Snapshot& snapshot,
                                         const PlaceIndex& places, LoopReport& report, TraceSink* trace) {
  const Span span(trace, "close_loop");
  report = {};
  report.keyframe = keyframe;
  const Map& map = *snapshot;
  if (!map.keyframes().contains(keyframe)) return std::nullopt;
  const bool pausing = last_closed_ && keyframe.index <= last_closed_->index + static_cast<std::uint32_t>(
                                                                                   options_.pause_keyframes);
  if (pausing) return std::nullopt;
  const MappedPlace here = place_around(map, keyframe, options_.neighbours + 1);
  const auto excluded = too_close(map, keyframe, options_.min_gap_keyframes);
  for (const Candidate& candidate :
       candidates(map, *map.keyframes().find(keyframe)->features, places, excluded)) {
    const MappedPlace there = place_around(map, candidate.keyframe, options_.place_keyframes);
    LoopReport attempt;
    attempt.keyframe = keyframe;
    attempt.place = candidate.keyframe;
    attempt.score = candidate.score;
    const auto loop = verify(map, here, there, map.up_in_world(), map.up_in_world(), attempt);
    if (loop) {
      const KeyframeGraph graph = graph_of(map, options_.drift);
      if (drift_passes(map, graph, there, *loop, attempt)) {
        last_closed_ = keyframe;
        MapEdit edit = correct(snapshot, graph, here, there, *loop, attempt);
        note(attempt, report);
        return edit;
      }
    }
    note(attempt, report);
  }
  return std::nullopt;
}

// Keeps the candidate that came furthest, and counts all.
void LoopCloser::note(const LoopReport& attempt, LoopReport& report) {
  auto attempts = report.attempts;
  ++attempts[static_cast<std::size_t>(attempt.verdict)];
  if (attempt.verdict > report.verdict) report = attempt;
  report.attempts = attempts;
}

std::vector<LoopCloser::Candidate> LoopCloser::candidates(const Map& map, const FeatureSet& features,
                                                          const PlaceIndex& places,
                                                          std::span<const std::uint8_t> excluded) const {
  constexpr int looked_at = 60;
  std::vector<std::uint8_t> covered(map.keyframes().index_bound(), 0);
  std::vector<Candidate> chosen;
  for (const PlaceMatch& match : places.query(features, looked_at, excluded)) {
    if (match.score < options_.min_score || !map.keyframes().contains(match.keyframe)) continue;
    // One keyframe stands for its place; its neighbours would say the same.
    if (covered[match.keyframe.index]) continue;
    for (const KeyframeId id : place_around(map, match.keyframe, options_.place_keyframes).keyframes)
      covered[id.index] = 1;
    chosen.push_back({match.keyframe, match.score});
    if (static_cast<int>(chosen.size()) >= options_.max_candidates) break;
  }
  return chosen;
}

std::optional<LoopAlignment> LoopCloser::verify(const Map& map, const MappedPlace& here,
                                                const MappedPlace& there,
                                                const std::optional<Eigen::Vector3d>& up_here,
                                                const std::optional<Eigen::Vector3d>& up_there,
                                                LoopReport& report) const {
  report.verdict = LoopVerdict::not_aligned;
  const Rng rng(seed_, "loop", (std::uint64_t{here.centre.index} << 32) | there.centre.index);
  auto loop = aligner_.align(map, here.centre, there, rng);
  if (!loop) return std::nullopt;
  report.inliers = static_cast<int>(loop->sights.size());

  report.verdict = LoopVerdict::unsupported;
  report.supporters = static_cast<int>(
      aligner_.supporters(map, *loop, there, without(here.keyframes, there.keyframes)).size());
  const int spared = report.inliers >= options_.alignment.strong_inliers ? 1 : 0;
  if (report.supporters < options_.alignment.supporters - spared) return std::nullopt;

  const Se3 correction =
      loop->world_from_camera * map.keyframes().find(here.centre)->world_from_camera.inverse();
  report.off_m = (loop->world_from_camera.translation() -
                  map.keyframes().find(here.centre)->world_from_camera.translation())
                     .norm();
  report.off_rad = rotation_angle(correction.rotation());
  report.verdict = LoopVerdict::tilted;
  if (!stays_upright(correction, up_here, up_there, options_.checks)) return std::nullopt;
  if (!surfaces_pass(map, here, there, correction, report)) return std::nullopt;
  return loop;
}

bool LoopCloser::surfaces_pass(const Map& map, const MappedPlace& here, const MappedPlace& there,
                               const Se3& correction, LoopReport& report) const {
  report.verdict = LoopVerdict::surfaces_disagree;
  report.surfaces = compare_surfaces(placed_patches(map, here.keyframes, correction),
                                     placed_patches(map, there.keyframes, Se3{}), options_.checks);
  if (!surfaces_agree(report.surfaces, options_.checks)) return false;

  report.verdict = LoopVerdict::through_walls;
  const FreeSpaceCount onward = count_seen_through(map, camera_, here.keyframes, correction, there.keyframes);
  const FreeSpaceCount back =
      count_seen_through(map, camera_, there.keyframes, correction.inverse(), here.keyframes);
  report.free_space = {onward.seen + back.seen, onward.through + back.through};
  return leaves_free_space_free(onward, options_.checks) && leaves_free_space_free(back, options_.checks);
}

bool LoopCloser::drift_passes(const Map& map, const KeyframeGraph& graph, const MappedPlace& there,
                              const LoopAlignment& loop, LoopReport& report) const {
  report.verdict = LoopVerdict::beyond_drift;
  const auto drift = drift_between(graph, options_.drift, there.centre, loop.keyframe);
  if (!drift) return false;
  const Se3 place_from_world = map.keyframes().find(there.centre)->world_from_camera.inverse();
  report.drift_sigmas =
      drift_sigmas(place_from_world * map.keyframes().find(loop.keyframe)->world_from_camera,
                   place_from_world * loop.world_from_camera, *drift, loop.information);
  return report.drift_sigmas <= options_.checks.max_drift_sigmas;
}

MapEdit LoopCloser::correct(const Snapshot& snapshot, const KeyframeGraph& graph, const MappedPlace& here,
                            const MappedPlace& there, const LoopAlignment& loop, LoopReport& report) const {
  Draft draft(snapshot);
  const LoopCorrectionOptions& o = options_.correction;
  report.verdict = LoopVerdict::joined;
  if (report.off_m > o.negligible_m || report.off_rad > o.negligible_deg * rad_per_deg) {
    report.verdict = LoopVerdict::closed;
    move_map(spread_correction(*snapshot, graph, loop, there.centre, o, report.pose_graph), draft);
  }
  merge_duplicates(here, there, loop, draft);
  return draft.take();
}

void LoopCloser::merge_duplicates(const MappedPlace& here, const MappedPlace& there,
                                  const LoopAlignment& loop, Draft& draft) const {
  join_sights(loop, draft);
  for (const KeyframeId id : without(here.keyframes, there.keyframes))
    fuse_into_neighbours(camera_, pyramid_, id, there.keyframes, draft);
  for (const KeyframeId id : there.keyframes)
    fuse_into_neighbours(camera_, pyramid_, id, without(here.keyframes, there.keyframes), draft);
  merge_coinciding_planes(here.keyframes, there.keyframes, options_.checks, draft);
}

namespace {

// At most so many that looking from all of one map at all of another, and back, takes 0.3 s.
std::vector<KeyframeId> evenly(const Map& map) {
  constexpr std::size_t enough = 60;
  std::vector<KeyframeId> all, some;
  map.keyframes().for_each([&all](KeyframeId id, const Keyframe&) { all.push_back(id); });
  const std::size_t taken = std::min(all.size(), enough);
  for (std::size_t i = 0; i < taken; ++i) some.push_back(all[i * all.size() / taken]);
  return some;
}

}  // namespace

std::optional<MapJoin> LoopCloser::join(KeyframeId keyframe, const Snapshot& snapshot, const KnownMap& other,
                                        LoopReport& report, TraceSink* trace) {
  const Span span(trace, "join_maps");
  report = {};
  report.keyframe = keyframe;
  const Keyframe* now = snapshot->keyframes().find(keyframe);
  if (!now) return std::nullopt;
  const auto likely = candidates(*other.map, *now->features, *other.places, {});
  if (likely.empty()) return std::nullopt;
  // Side by side in one table, each where its own world has it: an alignment is a loop between the two.
  Map both = *snapshot;
  both.apply(AbsorbMap{other.map, Se3{}});
  const MappedPlace here = place_around(both, keyframe, options_.neighbours + 1);
  for (const Candidate& candidate : likely) {
    const MappedPlace there = place_around(both, candidate.keyframe, options_.place_keyframes);
    LoopReport attempt;
    attempt.keyframe = keyframe;
    attempt.place = candidate.keyframe;
    attempt.score = candidate.score;
    const auto loop = verify(both, here, there, snapshot->up_in_world(), other.map->up_in_world(), attempt);
    if (loop && neighbours_pass(both, snapshot, other.map, *loop, attempt)) {
      attempt.verdict = LoopVerdict::closed;
      note(attempt, report);
      last_closed_ = keyframe;
      return join_maps(snapshot, other.map, here, there, *loop);
    }
    note(attempt, report);
  }
  return std::nullopt;
}

bool LoopCloser::neighbours_pass(const Map& both, const Snapshot& ours, const Snapshot& theirs,
                                 const LoopAlignment& loop, LoopReport& report) const {
  report.verdict = LoopVerdict::neighbours_disagree;
  const std::vector<KeyframeId> moved = evenly(*ours), standing = evenly(*theirs);
  const Se3 correction =
      loop.world_from_camera * ours->keyframes().find(loop.keyframe)->world_from_camera.inverse();
  Slack slack;
  slack.share = options_.drift.share_of_way;
  slack.centre = loop.world_from_camera.translation();
  const FreeSpaceCount onward = count_seen_through(both, camera_, moved, correction, standing, slack);
  slack.centre = correction.inverse() * slack.centre;
  const FreeSpaceCount back = count_seen_through(both, camera_, standing, correction.inverse(), moved, slack);
  report.neighbours = onward;
  report.neighbours += back;
  return neighbours_agree(onward, options_.checks) && neighbours_agree(back, options_.checks);
}

MapJoin LoopCloser::join_maps(const Snapshot& snapshot, const Snapshot& other, const MappedPlace& here,
                              const MappedPlace& there, const LoopAlignment& loop) const {
  const Se3 other_from_world =
      (loop.world_from_camera * snapshot->keyframes().find(loop.keyframe)->world_from_camera.inverse())
          .normalized();
  MapJoin join;
  join.onto_other = other->keyframes().first() < snapshot->keyframes().first();
  join.older_from_younger = join.onto_other ? other_from_world : other_from_world.inverse();
  Draft draft(join.onto_other ? other : snapshot);
  if (join.onto_other)
    draft.record(OpenMap{FirstIds::later(snapshot->unused_ids(), other->unused_ids()), snapshot->version()});
  draft.record(AbsorbMap{join.onto_other ? snapshot : other, join.older_from_younger});
  merge_duplicates(here, there, loop, draft);
  join.edit = draft.take();
  return join;
}

}  // namespace vsgraphs
