#include "core/system/run/frame_records.h"

#include <algorithm>
#include <type_traits>

#include "core/base/check.h"

namespace vsgraphs {

namespace {

static_assert(std::is_trivially_copyable_v<FrameRecords::Packed>);

FrameRecords::Packed pack(const FrameRecord& record) {
  const Se3& pose = record.pose.keyframe_from_camera;
  FrameRecords::Packed packed{record.index, record.timestamp_s, record.pose.keyframe, {}, {}};
  Eigen::Matrix3d::Map(packed.rotation.data()) = pose.rotation();
  Eigen::Vector3d::Map(packed.translation.data()) = pose.translation();
  return packed;
}

FrameRecord unpack(const FrameRecords::Packed& packed) {
  return {packed.index,
          packed.timestamp_s,
          {packed.keyframe, Se3(Eigen::Matrix3d::Map(packed.rotation.data()),
                                Eigen::Vector3d::Map(packed.translation.data()))}};
}

}  // namespace

void FrameRecords::View::for_each(const std::function<void(const FrameRecord&)>& function) const {
  std::unique_ptr<Chunk> read;
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    const Chunk* chunk = chunks_[c].get();
    if (!chunk) {
      if (!read) read = std::make_unique<Chunk>();
      file_->read(c * sizeof(Chunk), read->data(), sizeof(Chunk));
      chunk = read.get();
    }
    const std::size_t count = std::min(chunk_size, size_ - c * chunk_size);
    std::for_each_n(chunk->begin(), count, [&](const Packed& packed) { function(unpack(packed)); });
  }
  if (newest_) function(*newest_);
}

void FrameRecords::append(const FrameRecord& record) {
  const std::lock_guard lock(mutex_);
  settle_newest();
  newest_ = record;
}

const FrameRecord* FrameRecords::unnamed() const {
  return newest_ && !newest_->pose.keyframe.valid() ? &*newest_ : nullptr;
}

void FrameRecords::name_newest(KeyframeId keyframe) {
  const std::lock_guard lock(mutex_);
  VSG_INVARIANT(newest_.has_value());
  newest_->pose.keyframe = keyframe;
}

void FrameRecords::settle_newest() {
  if (!newest_) return;
  if (size_ % chunk_size == 0) {
    if (chunks_.size() >= in_file_ + chunks_in_memory) move_to_file();
    chunks_.push_back(std::make_shared<Chunk>());
  }
  (*chunks_.back())[size_++ % chunk_size] = pack(*newest_);
  newest_.reset();
}

// The oldest that is in memory. Who has a view of it keeps it there.
void FrameRecords::move_to_file() {
  if (file_fails_) return;
  if (!file_) file_ = ScratchFile::make();
  file_fails_ = !file_ || !file_->write(in_file_ * sizeof(Chunk), chunks_[in_file_]->data(), sizeof(Chunk));
  if (!file_fails_) chunks_[in_file_++].reset();
}

FrameRecords::View FrameRecords::view() const {
  View view;
  const std::lock_guard lock(mutex_);
  view.chunks_.assign(chunks_.begin(), chunks_.end());
  view.file_ = file_;
  view.size_ = size_;
  view.newest_ = newest_;
  return view;
}

std::int64_t FrameRecords::size() const {
  const std::lock_guard lock(mutex_);
  return static_cast<std::int64_t>(size_ + (newest_ ? 1 : 0));
}

std::size_t FrameRecords::chunks_in_file() const {
  const std::lock_guard lock(mutex_);
  return in_file_;
}

}  // namespace vsgraphs
