// The whole system behind one class: frames in, trajectory and map out.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "core/matching/messages.h"
#include "core/system/config/config.h"
#include "core/system/maps/markers.h"
#include "core/system/run/executor.h"
#include "core/system/run/frame_records.h"
#include "core/system/run/segmentation.h"

namespace vsgraphs {

struct TimedPose {
  double timestamp_s = 0;
  Se3 world_from_camera;
};

struct RunStatistics {
  std::int64_t frames = 0;   // handed to track()
  std::int64_t tracked = 0;  // of them, with a pose
  double waited_s = 0;       // tracking waiting for mapping
  int maps = 0;              // that are not joined, the one given out included
  int loops = 0;             // closed
  int merges = 0;            // maps joined with another
  LoopTallies tallies;       // what became of the places that looked alike
  // Tracked frames that are in other maps than the one given out, or in none any more; counted at the end.
  std::int64_t elsewhere = 0;
  std::map<std::string, StageStatistics> stages;
  std::vector<std::string> warnings;
};

// Belongs to the process that made it: a forked child has its locks and not its threads. There everything throws RunError, and
// the destructor leaves to the system what it cannot end.
class Slam {
 public:
  // Throws InputError if configuration or camera make no sense, or a schedule to replay cannot be read.
  Slam(const Config& config, const Camera& camera);
  // Starts from maps made before (none: as above): the camera begins lost, is looked for in them, and starts a map of its own
  // where it is not found; the two are joined where a place is recognised. Frames are counted on from the last keyframe's.
  // With system.localise_only the maps stay as they are. Throws InputError where that is asked for without a map.
  // `listener` (may be null) is told of keyframes, rooms and loops, on the thread that maps.
  Slam(const Config& config, const Camera& camera, const AtlasState& known,
       std::shared_ptr<MapListener> listener = nullptr);
  ~Slam();

  // Tracks one frame; the images are read during the call only. One caller at a time. Throws InputError for a
  // timestamp that is not finite or not later than the last one's, or images that do not fit the camera; such a
  // frame changes nothing and the next one can follow. Throws InputError after finish().
  TrackedFrame track(RgbdFrame frame);

  // A segmentation of the image of an earlier frame (TrackedFrame::index). Any thread, before finish(); afterwards, and
  // for frames that are no keyframes, it has no effect. `roles`: any size, stretched over the image; `confidence` 0..1
  // (empty: 1 everywhere), `instances` and `classes` (empty: none) of the same size. Throws InputError for other sizes or values, for
  // classes beyond `class_names`, and for a name whose number (class_id) another one has in this run or in the maps it began with.
  void add_segmentation(std::int64_t frame_index, const Segmentation& segmentation);

  // Markers seen in the image of an earlier frame, in place of what was said of it before; when and where as above. A number
  // may come twice. Throws InputError for sizes that are not positive, poses that are not finite and covariances that are
  // not positive definite.
  void add_markers(std::int64_t frame_index, MarkerDetections detections);

  // The newest published map; any thread, any time. Cost: one pointer.
  Snapshot snapshot() const;
  // All maps with all that was derived from them, the one being worked on last: what a run can go on from. Any thread, any time;
  // tracking is not held up (a serial run's is). Waits until mapping has done the keyframe that it is at; cost: a copy of
  // what is known of the surfaces, some milliseconds in a large map, for which mapping waits.
  AtlasState atlas_state() const;
  // Keyframes waiting for the mapper. Any thread, any time, at a cost that does not grow; tracking is not held up.
  std::int64_t backlog() const;

  // Any thread, any time, also while another one is in track() or finish(): nothing that takes long is begun from here on. A
  // track() that waits for mapping passes its frame over, as do all later ones (status waiting, nothing counted); keyframes
  // that wait for mapping are left out, the whole map is no longer adjusted. finish() is still to be called, and soon done.
  void stop();
  // Ends the work that is under way; further calls of track() are an error. May be called twice. Throws what went
  // wrong in a worker, RunError where a replay departed; the trajectory so far can still be asked for.
  void finish();

  // Poses of all frames that have one, in order, corrected by everything learned since, in the map of snapshot(): frames in
  // maps that were never joined with it are left out (see RunStatistics). With system.localise_only: in the map that holds
  // most of them. Any thread, any time; tracking is not held up. Cost: linear in frames and keyframes, on the caller's thread.
  std::vector<TimedPose> trajectory() const;
  // Any thread, any time, at a cost that does not grow while frames come; tracking is not held up. `stages`, `elsewhere` and
  // what is warned of at the end are there after finish() alone, as the workers write them until then.
  RunStatistics statistics() const;
  // Empty before finish() has returned.
  std::vector<const SpanRecorder*> spans() const;

 private:
  void require_own_process() const;
  void note_status(const TrackedFrame& frame);
  void keep_record(const TrackedFrame& frame);
  void warn(std::string line);
  Snapshot map_given_out(const FrameRecords::View& records) const;
  void add_what_the_end_tells(RunStatistics& s) const;

  // Held while a frame is tracked and while the run ends: a second caller of track() is told so. Readers never take it.
  std::mutex frames_mutex_;
  const int process_;
  Config config_;
  Camera camera_;
  std::unique_ptr<Executor> executor_;
  AtlasVersion loaded_;
  FrameRecords records_;
  ClassRegister classes_;
  mutable std::mutex warnings_mutex_;  // held for as long as it takes to copy the lines
  std::vector<std::string> warnings_;
  std::atomic<std::int64_t> frames_ = 0;
  std::int64_t first_index_ = 0;
  double last_timestamp_s_;
  bool lost_ = false, starts_lost_ = false;
  std::atomic<bool> finished_ = false;  // no frames come any more
  std::atomic<bool> ended_ = false;     // and all work is done
};

}  // namespace vsgraphs
