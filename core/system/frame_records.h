// Where each tracked frame was, kept for as long as the run lasts: one writer, any number of readers, none of whom waits for
// another longer than it takes to copy some pointers.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/map/map.h"

namespace vsgraphs {

struct FrameRecord {
  std::int64_t index = 0;
  double timestamp_s = 0;
  AnchoredPose pose;  // names no keyframe where the frame started a map whose first keyframe is not made yet
};

class FrameRecords {
 public:
  static constexpr std::size_t chunk_size = 1024;
  using Chunk = std::array<FrameRecord, chunk_size>;

  // What was there at one moment; it never changes, and costs a pointer per 1,024 frames.
  class View {
   public:
    std::size_t size() const { return size_ + (newest_ ? 1 : 0); }
    // In order.
    template <typename Function>
    void for_each(Function&& function) const {
      for (std::size_t i = 0; i < size_; ++i) function((*chunks_[i / chunk_size])[i % chunk_size]);
      if (newest_) function(*newest_);
    }

   private:
    friend class FrameRecords;
    std::vector<std::shared_ptr<const Chunk>> chunks_;
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

 private:
  void settle_newest();

  mutable std::mutex mutex_;
  // Written only beyond the size that any reader was told.
  std::vector<std::shared_ptr<Chunk>> chunks_;
  std::size_t size_ = 0;
  std::optional<FrameRecord> newest_;  // may still be named; what is in a chunk is final
};

}  // namespace vsgraphs
