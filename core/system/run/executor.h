// How the stages are run: one after the other, side by side, or along a recorded schedule. The stages are the same.
#pragma once

#include <memory>
#include <vector>

#include "core/geometry/camera.h"
#include "core/map/label_grid.h"
#include "core/matching/messages.h"
#include "core/system/config/config.h"
#include "core/system/maps/map_listener.h"
#include "core/system/maps/markers.h"
#include "core/system/maps/schedule.h"
#include "core/system/maps/snapshot_cell.h"
#include "core/system/maps/span_recorder.h"

namespace vsgraphs {

class Executor {
 public:
  virtual ~Executor() = default;
  // Empty where the executor passes the frame over (a replay of a run that never saw it).
  virtual std::optional<TrackedFrame> track(const RgbdFrame& frame) = 0;
  // A segmentation of an earlier frame's image; without effect where that frame is no keyframe.
  virtual void label(std::int64_t frame_index, std::shared_ptr<const LabelGrid> labels) = 0;
  // Markers seen in an earlier frame's image; likewise.
  virtual void mark(std::int64_t frame_index, std::shared_ptr<const MarkerDetections> detections) = 0;
  // Waits for all work; afterwards the map is final. May be called twice.
  virtual void finish() = 0;
  // Any thread, any time: nothing that takes long is begun from here on. A track() that waits for mapping comes back empty, as
  // do all later ones; requests that wait are left out, an adjustment of the whole map is dropped between two iterations.
  virtual void stop() = 0;

  // The newest maps; any thread.
  virtual SnapshotCell::Content content() const = 0;
  // All maps with all that follows them, the one worked on last; maps without keyframes are none. Any thread; it waits for the
  // frame or the keyframe that is being worked on, and holds up mapping while what follows the map is copied.
  virtual std::vector<MapState> maps() const = 0;
  virtual std::int64_t backlog() const = 0;
  // Time the tracker spent waiting for the mapper, s.
  virtual double waited_s() const { return 0.0; }
  // Complete after finish().
  virtual std::vector<const SpanRecorder*> spans() const = 0;
  virtual Schedule schedule() const = 0;
};

// `known`: what the run starts from; `listener` may be null; see MapOwner.
std::unique_ptr<Executor> make_serial_executor(const Config& config, const Camera& camera,
                                               const AtlasState& known,
                                               std::shared_ptr<MapListener> listener);
std::unique_ptr<Executor> make_threaded_executor(const Config& config, const Camera& camera,
                                                 const AtlasState& known,
                                                 std::shared_ptr<MapListener> listener);
// Follows config.system.replay. track() and finish() throw RunError when the run departs from it.
std::unique_ptr<Executor> make_replaying_executor(const Config& config, const Camera& camera,
                                                  const AtlasState& known,
                                                  std::shared_ptr<MapListener> listener);

}  // namespace vsgraphs
