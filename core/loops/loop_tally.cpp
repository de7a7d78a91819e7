#include "core/loops/loop_tally.h"

#include <algorithm>
#include <tuple>

namespace vsgraphs {

namespace {

double share(double part, double rest) { return part + rest > 0 ? part / (part + rest) : 0; }
double through_share(const FreeSpaceCount& count) {
  return count.seen > 0 ? static_cast<double>(count.through) / count.seen : 0;
}

// Aligned, and then refused.
bool is_refusal(LoopVerdict verdict) {
  return verdict > LoopVerdict::not_aligned && verdict < LoopVerdict::joined;
}

bool nearer(const RefusedLoop& a, const RefusedLoop& b) {
  return std::tuple(a.verdict, a.inliers, b.frame) > std::tuple(b.verdict, b.inliers, a.frame);
}

}  // namespace

void LoopTally::add(const LoopReport& report, const Map& here, const Map& there) {
  for (std::size_t i = 0; i < verdicts.size(); ++i) verdicts[i] += report.attempts[i];
  const Keyframe* keyframe = here.keyframes().find(report.keyframe);
  const Keyframe* place = there.keyframes().find(report.place);
  if (!is_refusal(report.verdict) || !keyframe || !place) return;
  RefusedLoop refused;
  refused.verdict = report.verdict;
  refused.frame = keyframe->frame_index;
  refused.place_frame = place->frame_index;
  refused.timestamp_s = keyframe->timestamp_s;
  refused.place_timestamp_s = place->timestamp_s;
  refused.score = report.score;
  refused.inliers = report.inliers;
  refused.supporters = report.supporters;
  refused.off_m = report.off_m;
  refused.off_rad = report.off_rad;
  refused.drift_sigmas = report.drift_sigmas;
  refused.disagreeing_share = share(report.surfaces.disagreeing_m2, report.surfaces.agreeing_m2);
  refused.seen_through_share = std::max(through_share(report.free_space), through_share(report.neighbours));
  nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), refused, nearer), refused);
  if (nearest.size() > most_nearest) nearest.pop_back();
}

}  // namespace vsgraphs
