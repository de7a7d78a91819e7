// The tracker with its clock and its log of which map version each frame saw; shared by all executors.
#pragma once

#include <atomic>
#include <limits>

#include "core/system/config/config.h"
#include "core/system/maps/map_owner.h"
#include "core/system/maps/schedule.h"
#include "core/system/maps/span_recorder.h"
#include "core/tracking/tracker.h"

namespace vsgraphs {

class TrackingLane {
 public:
  TrackingLane(const Config& config, const Camera& camera)
      : localise_only_(config.system.localise_only),
        records_schedule_(config.system.records_schedule()),
        tracker_(tracker_options(config), config.orb, camera, static_cast<std::uint64_t>(config.system.seed)),
        spans_("tracking") {}

  TrackedFrame track(const RgbdFrame& frame, const SnapshotCell::Content& content) {
    spans_.set_frame(frame.index);
    TrackedFrame result;
    {
      const Span span(&spans_, "track");
      KnownMaps known{{content.snapshot, content.places}, {}};
      for (const MapState& map : *content.dormant) known.dormant.push_back({map.map, map.places()});
      result = tracker_.track(frame, known, static_cast<int>(requested_ - content.inserted), &spans_);
    }
    if (localise_only_) result.keyframe_request.reset();
    if (records_schedule_) frames_.push_back({frame.index, frame.timestamp_s, content.snapshot->version()});
    if (result.keyframe_request) ++requested_;
    return result;
  }

  std::int64_t requested() const { return requested_; }
  const SpanRecorder& spans() const { return spans_; }
  const std::vector<FrameEvent>& frames() const { return frames_; }

 private:
  static TrackerOptions tracker_options(const Config& config) {
    TrackerOptions options = config.tracker;
    if (config.system.localise_only) options.new_map_after_s = std::numeric_limits<double>::infinity();
    return options;
  }

  bool localise_only_, records_schedule_;
  Tracker tracker_;
  SpanRecorder spans_;
  std::vector<FrameEvent> frames_;
  std::atomic<std::int64_t> requested_ = 0;  // read by others
};

// Tracking's lane and the map owner's.
inline std::vector<const SpanRecorder*> lanes(const TrackingLane& tracking, const MapOwner& owner) {
  std::vector<const SpanRecorder*> all = owner.spans();
  all.insert(all.begin(), &tracking.spans());
  return all;
}

}  // namespace vsgraphs
