// What happened when in a threaded run: which map version each frame saw and which edits were made, in order.
// With the same frames, following it gives the same run. A text file, one line per event:
//   frame INDEX STAMP VERSION         the frame was tracked on that version of the map (stamp: bits of the double)
//   insert FRAME HASH                 the frame became a keyframe; hash of the edit
//   planes FRAME HASH                 its planes were sought
//   labels FRAME HASH                 a segmentation of its image arrived
//   markers FRAME HASH                markers seen in its image arrived
//   rooms FRAME HASH                  rooms, floors and doors were sought
//   rooms_last FRAME HASH             the same at the end of the run
//   loop FRAME HASH                   it closed a loop
//   new_map FRAME HASH                it starts a new map
//   resume FRAME HASH                 it is anchored in a dormant map, which is worked on again
//   join FRAME HASH                   it showed a place of a dormant map: the two became one
//   settle FRAME HASH                 at the end: the map this run made most of is taken up again
//   adjust FRAME ITERATIONS HASH      after which the adjustment of the whole map, asked for before, was taken in
//   refine FRAME ITERATIONS HASH      its window was adjusted with that many iterations
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vsgraphs {

struct FrameEvent {
  std::int64_t frame = 0;
  double timestamp_s = 0;
  std::uint64_t version = 0;
};

struct EditEvent {
  enum class Kind {
    insert,
    planes,
    labels,
    roles,
    markers,
    rooms,
    rooms_last,
    loop,
    adjust,
    refine,
    new_map,
    resume,
    join,
    settle
  };
  Kind kind = Kind::insert;
  std::int64_t frame = 0;
  int iterations = 0;  // of refine and adjust
  bool iterates() const { return kind == Kind::refine || kind == Kind::adjust; }
  std::uint64_t hash = 0;
  bool operator==(const EditEvent&) const = default;
};

// The two sequences are kept apart, as they come from two threads; `version` ties them together: version n is
// the map after the first n edits.
struct Schedule {
  std::vector<FrameEvent> frames;
  std::vector<EditEvent> edits;

  // Throws InputError naming the file (and line).
  static Schedule read(const std::string& path);
  // Written beside and renamed, so that a full disk leaves no half schedule. Throws InputError.
  void write(const std::string& path) const;
};

}  // namespace vsgraphs
