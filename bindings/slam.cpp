#include "core/system/run/slam.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/classes.h"
#include "bindings/images.h"
#include "bindings/markers.h"
#include "core/base/check.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace vsgraphs {

namespace {

nb::object pose_or_none(const TrackedFrame& frame) {
  if (!has_pose(frame.status)) return nb::none();
  std::vector<double> rows;
  append_rows(rows, frame.world_from_camera);
  return nb::cast(to_numpy(std::move(rows), {4, 4}));
}

nb::tuple keyframes_of(const Map& map) {
  std::vector<std::uint32_t> ids;
  std::vector<double> stamps, poses;
  map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    ids.push_back(id.index);
    stamps.push_back(keyframe.timestamp_s);
    append_rows(poses, keyframe.world_from_camera);
  });
  const std::size_t n = ids.size();
  return nb::make_tuple(to_numpy(std::move(ids), {n}), to_numpy(std::move(stamps), {n}),
                        to_numpy(std::move(poses), {n, 4, 4}));
}

nb::tuple landmarks_of(const Map& map) {
  std::vector<double> points;
  std::vector<std::uint8_t> colours;
  map.landmarks().for_each([&](LandmarkId, const Landmark& landmark) {
    for (int k = 0; k < 3; ++k) points.push_back(landmark.point_in_world[k]);
    const Rgb& c = landmark.appearance.colour;
    colours.insert(colours.end(), {c.r, c.g, c.b});
  });
  const std::size_t n = points.size() / 3;
  return nb::make_tuple(to_numpy(std::move(points), {n, 3}), to_numpy(std::move(colours), {n, 3}));
}

nb::tuple trajectory_of(const Slam& slam) {
  std::vector<double> stamps, poses;
  {
    const nb::gil_scoped_release release;  // milliseconds after an hour: whoever tracks goes on meanwhile
    for (const TimedPose& pose : slam.trajectory()) {
      stamps.push_back(pose.timestamp_s);
      append_rows(poses, pose.world_from_camera);
    }
  }
  const std::size_t n = stamps.size();
  return nb::make_tuple(to_numpy(std::move(stamps), {n}), to_numpy(std::move(poses), {n, 4, 4}));
}

nb::dict refused_of(const RefusedLoop& refused) {
  nb::dict d;
  d["verdict"] = to_string(refused.verdict);
  d["frame"] = refused.frame;
  d["place_frame"] = refused.place_frame;
  d["timestamp_s"] = refused.timestamp_s;
  d["place_timestamp_s"] = refused.place_timestamp_s;
  d["score"] = refused.score;
  d["inliers"] = refused.inliers;
  d["supporters"] = refused.supporters;
  d["off_m"] = refused.off_m;
  d["off_rad"] = refused.off_rad;
  d["drift_sigmas"] = refused.drift_sigmas;
  d["disagreeing_share"] = refused.disagreeing_share;
  d["seen_through_share"] = refused.seen_through_share;
  return d;
}

nb::dict tally_of(const LoopTally& tally) {
  nb::dict verdicts, result;
  for (std::size_t i = 0; i < tally.verdicts.size(); ++i) {
    if (tally.verdicts[i] > 0) verdicts[to_string(static_cast<LoopVerdict>(i))] = tally.verdicts[i];
  }
  nb::list nearest;
  for (const RefusedLoop& refused : tally.nearest) nearest.append(refused_of(refused));
  result["verdicts"] = verdicts;
  result["nearest_refused"] = nearest;
  return result;
}

nb::dict statistics_of(const Slam& slam) {
  const RunStatistics s = [&slam] {
    const nb::gil_scoped_release release;
    return slam.statistics();
  }();
  nb::dict stages;
  for (const auto& [name, stage] : s.stages) {
    nb::dict d;
    d["count"] = stage.count;
    d["median_ms"] = stage.median_ms;
    d["p95_ms"] = stage.p95_ms;
    d["max_ms"] = stage.max_ms;
    d["cpu_median_ms"] = stage.cpu_median_ms;
    d["cpu_p95_ms"] = stage.cpu_p95_ms;
    stages[name.c_str()] = d;
  }
  nb::dict result;
  result["frames"] = s.frames;
  result["tracked"] = s.tracked;
  result["waited_s"] = s.waited_s;
  result["maps"] = s.maps;
  result["loops"] = s.loops;
  result["merges"] = s.merges;
  result["elsewhere"] = s.elsewhere;
  result["loop_candidates"] = tally_of(s.tallies.loops);
  result["join_candidates"] = tally_of(s.tallies.joins);
  result["stages"] = stages;
  result["warnings"] = s.warnings;
  return result;
}

nb::list trace_of(const Slam& slam) {
  nb::list events;
  for (const SpanRecorder* recorder : slam.spans()) {
    for (const SpanRecord& span : recorder->spans()) {
      events.append(nb::make_tuple(recorder->lane(), span.name, span.begin_us, span.duration_us, span.frame));
    }
  }
  return events;
}

void bind_results(nb::module_& m) {
  nb::class_<TrackedFrame>(m, "TrackResult", "What became of one frame.")
      .def_prop_ro(
          "status", [](const TrackedFrame& f) { return to_string(f.status); },
          "waiting, initialised, ok, coasting, lost or relocalised")
      .def_prop_ro(
          "index", [](const TrackedFrame& f) { return f.index; },
          "the frame's number: from 0, or on from the last keyframe of an atlas")
      .def_prop_ro("tracked", [](const TrackedFrame& f) { return has_pose(f.status); })
      .def_prop_ro(
          "world_from_camera", &pose_or_none,
          nb::sig("def world_from_camera(self) -> numpy.typing.NDArray[numpy.float64] | None"),
          "(4, 4) float64 as known when the frame was tracked; None without a pose. World: the first "
          "keyframe's camera.")
      .def_prop_ro("is_keyframe", [](const TrackedFrame& f) { return f.keyframe_request != nullptr; })
      .def_prop_ro(
          "matches", [](const TrackedFrame& f) { return f.matches; }, "inlier matches behind the pose");

  nb::class_<Map>(m, "Snapshot", "The map at one moment; it never changes.")
      .def_prop_ro("version", &Map::version)
      .def("keyframes", &keyframes_of,
           nb::sig("def keyframes(self) -> tuple[numpy.typing.NDArray[numpy.uint32], "
                   "numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]"),
           "(ids (N,) uint32, timestamps (N,) float64 s, world_from_camera (N, 4, 4) float64)")
      .def("landmarks", &landmarks_of,
           nb::sig("def landmarks(self) -> tuple[numpy.typing.NDArray[numpy.float64], "
                   "numpy.typing.NDArray[numpy.uint8]]"),
           "(points in the world (M, 3) float64 m, colours (M, 3) uint8)")
      .def_prop_ro("class_names", &class_names_of, nb::sig("def class_names(self) -> list[str]"),
                   "Of all classes that a segmenter named, sorted.")
      .def(
          "keyframe_classes", &keyframe_classes_of, "keyframe"_a,
          nb::sig("def keyframe_classes(self, keyframe: int) -> dict[str, typing.Any] | None"),
          "What a segmenter named in the image of the keyframe of that id, at the samples of its depth grid: "
          "class_names\n"
          "(list of str), classes ((rows, columns) uint16: 0 none, k the k-th name), confidence (float32, 0 "
          "to "
          "1) and\n"
          "instances (uint16, 0: none). None where it named nothing, or there is no such keyframe.")
      .def("scene_graph", &scene_graph_of, nb::sig("def scene_graph(self) -> dict[str, typing.Any]"),
           "Planes and what is made of them, in the world (the first keyframe's camera): what "
           "vsgraphs.scene_graph.SceneGraph.from_map takes. Linear in the points kept of the planes.");
}

}  // namespace

void bind_slam(nb::module_& m) {
  bind_results(m);
  nb::class_<AtlasState>(m, "AtlasState",
                         "All maps of a run as values, for another run to start from; it never changes.")
      .def(nb::init<>(), "No map at all.")
      .def_prop_ro(
          "maps", [](const AtlasState& atlas) { return atlas.maps.size(); },
          "maps that are not joined, each in a world of its own")
      .def_prop_ro(
          "keyframes",
          [](const AtlasState& atlas) {
            std::size_t sum = 0;
            for (const MapState& state : atlas.maps) sum += state.map->keyframes().size();
            return sum;
          },
          "keyframes in all of them");
  nb::class_<Slam>(m, "Slam", "RGB-D SLAM: frames in, trajectory and map out.")
      .def(
          "__init__",
          [](Slam* self, const Config& config, const Camera& camera, const AtlasState& atlas,
             std::optional<bool> realtime) {
            Config wanted = config;
            if (realtime) wanted.system.realtime = *realtime;
            require_input(!realtime.value_or(false) || wanted.system.execution == "threaded",
                          "realtime: needs system.execution = threaded; serial execution does all mapping "
                          "within track()");
            new (self) Slam(wanted, camera, atlas);
          },
          "config"_a, "camera"_a, "atlas"_a = AtlasState{}, nb::kw_only(), "realtime"_a = nb::none(),
          nb::sig("def __init__(self, config: Config, camera: Camera, atlas: AtlasState = ..., *, realtime: "
                  "bool | None = None) -> None"),
          "Args:\n"
          "  config, camera: options, and the camera whose images will come.\n"
          "  atlas: maps of an earlier run (atlas_state()) to start from: the camera begins lost and is "
          "looked "
          "for in\n"
          "    them; where nothing is recognised it starts a map of its own, which is joined with them when "
          "a "
          "place\n"
          "    is. With system.localise_only the maps stay as they are.\n"
          "  realtime: True for a live camera: track() never waits for mapping, and answers within "
          "milliseconds.\n"
          "    False for a recording: track() waits where mapping lags, so that results do not depend on how "
          "fast the\n"
          "    machine is; that can take seconds. None: as config says (system.realtime, by default "
          "False).\n\n"
          "Raises InputError if configuration or camera make no sense, for realtime with serial execution, "
          "and "
          "for\n"
          "system.localise_only without a map.")
      .def(
          "track",
          [](Slam& slam, nb::object rgb, nb::object depth, double timestamp) {
            const GivenFrame given = frame_of(rgb, depth, timestamp);
            const nb::gil_scoped_release release;
            return slam.track(given.frame);
          },
          "rgb"_a.none(), "depth"_a.none(), "timestamp"_a,
          nb::sig("def track(self, rgb: numpy.typing.NDArray[numpy.uint8], depth: "
                  "numpy.typing.NDArray[numpy.uint16] | numpy.typing.NDArray[numpy.float32], timestamp: "
                  "float) -> "
                  "TrackResult"),
          "Tracks one frame; the images are only read during the call.\n\n"
          "Args:\n"
          "  rgb: uint8, (height, width, 3) in RGB order or (height, width) grey.\n"
          "  depth: (height, width), uint16 in raw units (Camera.depth_scale per metre) or float32 in "
          "metres.\n"
          "  timestamp: seconds, later than the last frame's.\n\n"
          "Raises InputError for wrong shapes or types and for timestamps that are not finite or do not "
          "rise; the\n"
          "frame then changes nothing. The GIL is released while tracking.")
      .def(
          "add_segmentation",
          [](Slam& slam, std::int64_t frame_index, nb::object roles, nb::object confidence,
             nb::object instances, nb::object classes, nb::object class_names) {
            const GivenSegmentation given =
                segmentation_of(roles, confidence, instances, classes, class_names);
            const nb::gil_scoped_release release;
            slam.add_segmentation(frame_index, given.segmentation());
          },
          "frame_index"_a, "roles"_a.none(), "confidence"_a = nb::none(), "instances"_a = nb::none(),
          "classes"_a = nb::none(), "class_names"_a = nb::none(),
          nb::sig("def add_segmentation(self, frame_index: int, roles: numpy.typing.NDArray[numpy.uint8], "
                  "confidence: numpy.typing.NDArray[numpy.float32] | None = None, instances: "
                  "numpy.typing.NDArray[numpy.uint16] | None = None, classes: "
                  "numpy.typing.NDArray[numpy.uint16] | None = None, class_names: "
                  "collections.abc.Sequence[str] | None = None) -> None"),
          "Says what the pixels of an earlier frame's image show; may come late and from any thread.\n\n"
          "Args:\n"
          "  frame_index: the frame's TrackResult.index. Frames that are no keyframes: no effect.\n"
          "  roles: (h, w) uint8, values of vsgraphs.segment.SurfaceRole; any size, stretched over the "
          "image.\n"
          "  confidence: (h, w) float32, 0 to 1; None: 1 everywhere.\n"
          "  instances: (h, w) uint16, pieces of one thing share a number, 0: none.\n"
          "  classes: (h, w) uint16, the segmenter's own classes: 0 none, k the k-th of class_names.\n"
          "  class_names: a list of up to 65535 different names, each of 1 to 128 bytes (UTF-8).\n\n"
          "Raises InputError for wrong shapes, types or values, and for two names of one number (FNV-1a, 32 "
          "bits).")
      .def(
          "add_markers",
          [](Slam& slam, std::int64_t frame_index, const Numbers& ids, const Reals& sizes, const Reals& poses,
             const Reals& covariances) {
            MarkerDetections detections = marker_detections_of(ids, sizes, poses, covariances);
            const nb::gil_scoped_release release;
            slam.add_markers(frame_index, std::move(detections));
          },
          "frame_index"_a, "ids"_a, "size_m"_a, "camera_from_marker"_a, "covariance"_a,
          nb::sig("def add_markers(self, frame_index: int, ids: numpy.typing.NDArray[numpy.int64], size_m: "
                  "numpy.typing.NDArray[numpy.float64], camera_from_marker: "
                  "numpy.typing.NDArray[numpy.float64], "
                  "covariance: numpy.typing.NDArray[numpy.float64]) -> None"),
          "Says which fiducial markers an earlier frame's image shows, in place of what was said of it "
          "before; "
          "may come late and from any thread.\n\n"
          "Args:\n"
          "  frame_index: the frame's TrackResult.index. Frames that are no keyframes: no effect.\n"
          "  ids: (N,) int64, the printed numbers; one that comes twice hangs in two places.\n"
          "  size_m: (N,) float64, sides of the black squares.\n"
          "  camera_from_marker: (N, 4, 4) float64; a marker's origin is in its middle, x to the right of "
          "who "
          "reads\n"
          "    it, y up, z out of the paper; the camera's x right, y down, z forward.\n"
          "  covariance: (N, 6, 6) float64 of (translation m, rotation rad), small moves applied on the "
          "right "
          "of\n"
          "    camera_from_marker.\n\n"
          "Raises InputError for wrong shapes and values.")
      .def(
          "snapshot", [](const Slam& s) { return std::const_pointer_cast<Map>(s.snapshot()); },
          "The newest map. Cheap, from any thread.")
      .def(
          "atlas_state", &Slam::atlas_state, nb::call_guard<nb::gil_scoped_release>(),
          "All maps as known now, with all that was derived from them. Any thread; tracking is not held up.\n"
          "Waits until mapping has done the keyframe that it is at.")
      .def("stop", &Slam::stop, nb::call_guard<nb::gil_scoped_release>(),
           "Has the run end soon; any thread, also while another one is in track() or finish().\n"
           "A track() that waits for mapping passes its frame over, as do all later ones (status waiting,\n"
           "nothing counted); keyframes that wait for mapping are left out, and the whole map is no longer\n"
           "adjusted. finish() is still to be called.")
      .def("finish", &Slam::finish, nb::call_guard<nb::gil_scoped_release>(),
           "Ends the work under way; track() is an error afterwards.")
      .def("close", &Slam::finish, nb::call_guard<nb::gil_scoped_release>(), "The same as finish().")
      .def("trajectory", &trajectory_of,
           nb::sig("def trajectory(self) -> tuple[numpy.typing.NDArray[numpy.float64], "
                   "numpy.typing.NDArray[numpy.float64]]"),
           "(timestamps (N,) float64 s, world_from_camera (N, 4, 4) float64) of all frames with a pose, "
           "corrected "
           "by everything learned since.")
      .def("statistics", &statistics_of, nb::sig("def statistics(self) -> dict[str, typing.Any]"),
           "frames, tracked, waited_s, maps (not joined), loops, merges, elsewhere (tracked frames in other "
           "maps "
           "than the one\n"
           "given out), loop_candidates and join_candidates (verdicts: how many candidates got each; "
           "nearest_refused: both\n"
           "frames, inliers, and what spoke against it), warnings and stages; elsewhere and stages after "
           "finish() alone.\n"
           "Any thread; tracking is not held up.")
      .def("trace", &trace_of, nb::sig("def trace(self) -> list[tuple[str, str, int, int, int]]"),
           "List of (lane, stage, begin_us, duration_us, frame); complete after finish(). Time is the "
           "monotonic "
           "clock's.")
      .def_prop_ro("backlog", &Slam::backlog, "keyframes waiting for the mapper");
}

}  // namespace vsgraphs
