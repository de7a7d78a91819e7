// All options in one place, found by dotted keys ("tracker.coast_s"). Names, defaults, ranges and meanings come
// from the stages' own `describe` functions; nothing is written down twice.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/loops/loop_closer.h"
#include "core/mapping/local_mapper.h"
#include "core/tracking/tracker.h"
#include "core/understanding/scene_builder.h"
#include "core/understanding/structure_builder.h"
#include "core/vision/orb_extractor.h"
#include "core/vision/place_index.h"

namespace vsgraphs {

// True in debug and sanitizer builds.
bool stops_on_fault_by_default();

struct SystemOptions {
  std::string mode = "full";
  std::string execution = "threaded";
  int seed = 0;
  bool realtime = false;
  bool loop_closing = true;
  bool localise_only = false;
  int min_map_keyframes = 5;
  bool builds_scene() const { return mode != "slam"; }
  bool builds_structure() const { return mode == "full"; }
  // Otherwise nobody asks for the schedule, which grows with the run.
  bool records_schedule() const { return !schedule_out.empty() || !replay.empty(); }
  double max_lag_s = 0.05;
  bool stop_on_fault = stops_on_fault_by_default();
  std::string schedule_out;
  std::string replay;
};

template <typename Visitor>
void describe(SystemOptions& o, Visitor& field) {
  field("mode", o.mode, AllowedValues{"slam", "bc", "full"},
        "what is estimated: slam (trajectory and landmarks), bc (and building components: walls, ground), "
        "full (and "
        "structural elements: rooms, floors)");
  field("execution", o.execution, AllowedValues{"threaded", "serial"},
        "threaded: mapping beside tracking; serial: one after the other, the same bytes on every run");
  field("seed", o.seed, 0, 2147483647, "seed of all random numbers");
  field("realtime", o.realtime, "never let tracking wait for mapping, as with a live camera");
  field("loop_closing", o.loop_closing, "recognise places seen before and correct the drift since then");
  field("localise_only", o.localise_only,
        "only locate the camera in the loaded maps and leave the maps as they are");
  field("min_map_keyframes", o.min_map_keyframes, 1, 1000,
        "a map of fewer keyframes is dropped when tracking is lost and a new map begins");
  field("max_lag_s", o.max_lag_s, 0.0, 10.0,
        "time by which mapping may lag behind tracking, in seconds of the recording; beyond it tracking "
        "waits, unless realtime");
  field("stop_on_fault", o.stop_on_fault,
        "end the run at a fault of the program in planes, rooms, markers, loops or adjustment; otherwise "
        "that part is switched off with a warning");
  field("schedule_out", o.schedule_out, AllowedValues{},
        "file to which the run's schedule is recorded, to replay it exactly");
  field("replay", o.replay, AllowedValues{}, "file with a recorded schedule to follow, edit by edit");
}

using OptionValue = std::variant<bool, std::int64_t, double, std::string>;

struct OptionDescription {
  std::string key;
  OptionValue value, default_value;
  double minimum = 0, maximum = 0;  // of numbers
  AllowedValues allowed;            // of texts; empty: any
  std::string meaning;
};

class Config {
 public:
  SystemOptions system;
  OrbOptions orb;
  TrackerOptions tracker;
  LocalMapperOptions mapper;
  SceneBuilderOptions scene;
  StructureBuilderOptions structure;
  LoopCloserOptions loop;
  FactorSwitches factors;
  PlaceIndexOptions places;

  // Throws InputError: unknown key (names the nearest), wrong type, out of range (names the range).
  void set(const std::string& key, const OptionValue& value);
  OptionValue get(const std::string& key) const;
  std::vector<OptionDescription> describe_all() const;
  // All ranges, and what ranges alone cannot tell. Throws InputError.
  void validate() const;

 private:
  template <typename Visitor>
  void visit(Visitor&& visitor);
};

}  // namespace vsgraphs
