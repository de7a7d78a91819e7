// Where each tracked frame was, kept for as long as the run lasts: one writer, any number of readers, none of whom waits for
// another longer than it takes to copy some pointers. The newest are in memory (2 MB), older ones in a file without a name, so that
// an hour takes no more memory than ten minutes; where no such file can be made or filled, all are in memory.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/map/map.h"
#include "core/system/run/scratch_file.h"

namespace vsgraphs {

struct FrameRecord {
  std::int64_t index = 0;
  double timestamp_s = 0;
  AnchoredPose pose;  // names no keyframe where the frame started a map whose first keyframe is not made yet
};

class FrameRecords {
 public:
  static constexpr std::size_t chunk_size = 1024;
  static constexpr std::size_t chunks_in_memory = 16;
  // Plain bytes, as they are in the file.
  struct Packed {
    std::int64_t index;
    double timestamp_s;
    KeyframeId keyframe;
    std::array<double, 9> rotation;
    std::array<double, 3> translation;
  };
  using Chunk = std::array<Packed, chunk_size>;

  // What was there at one moment; it never changes, and costs a pointer per 1,024 frames.
  class View {
   public:
    std::size_t size() const { return size_ + (newest_ ? 1 : 0); }
    // In order. Throws RunError where what was written to the file cannot be read.
    void for_each(const std::function<void(const FrameRecord&)>& function) const;

   private:
    friend class FrameRecords;
    std::vector<std::shared_ptr<const Chunk>> chunks_;  // null: in the file
    std::shared_ptr<const ScratchFile> file_;
    std::size_t size_ = 0;
    std::optional<FrameRecord> newest_;
  };

  // By the writer alone.
  void append(const FrameRecord& record);
  // The newest record while its pose names no keyframe; null otherwise. For the writer.
  const FrameRecord* unnamed() const;
  void name_newest(KeyframeId keyframe);

  // Any thread.
  View view() const;
  std::int64_t size() const;
  std::size_t chunks_in_file() const;

 private:
  void settle_newest();
  void move_to_file();

  mutable std::mutex mutex_;
  // Written only beyond the size that any reader was told.
  std::vector<std::shared_ptr<Chunk>> chunks_;  // null: in the file
  std::shared_ptr<ScratchFile> file_;
  std::size_t in_file_ = 0;  // chunks; the first ones
  bool file_fails_ = false;
  std::size_t size_ = 0;
  std::optional<FrameRecord> newest_;  // may still be named; what is in a chunk is final
};

}  // namespace vsgraphs
