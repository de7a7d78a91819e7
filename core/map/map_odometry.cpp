// The part of the map that deals with measured odometry.
#include "core/geometry/pose_covariance.h"
#include "core/map/map.h"

namespace vsgraphs {

namespace {

// A gap where nothing is known any more of where the two stand to one another.
OdometryStep composed(const OdometryStep& first, const OdometryStep& second) {
  const OdometryStep both{first.before, (first.before_from_camera * second.before_from_camera).normalized(),
                          compose_covariance(first.covariance, second.before_from_camera, second.covariance)};
  return is_covariance(both.covariance) ? both : OdometryStep{};
}

}  // namespace

void Map::pass_on_steps(KeyframeId gone) {
  const std::optional<OdometryStep> first = keyframes_.find(gone)->odometry;
  for (std::uint32_t index = gone.index + 1; index < keyframes_.index_bound(); ++index) {
    const KeyframeId id = keyframes_.at_index(index);
    const Keyframe* next = keyframes_.find(id);
    if (!next || !next->odometry || next->odometry->before != gone) continue;
    const OdometryStep second = *next->odometry;
    std::optional<OdometryStep>& passed_on = keyframes_.edit(id)->odometry;
    passed_on =
        first && first->before.valid() ? composed(*first, second) : first;  // a gap, or yet to be measured
  }
}

void Map::apply_one(const SetOdometry& op) {
  if (op.step.before.valid() && (op.step.before == op.id || !keyframes_.contains(op.step.before))) return;
  if (Keyframe* keyframe = keyframes_.edit(op.id)) keyframe->odometry = op.step;
}

}  // namespace vsgraphs
