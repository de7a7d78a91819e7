#include "core/system/frame_records.h"

#include "core/base/check.h"

namespace vsgraphs {

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
  if (size_ % chunk_size == 0) chunks_.push_back(std::make_shared<Chunk>());
  (*chunks_.back())[size_++ % chunk_size] = *newest_;
  newest_.reset();
}

FrameRecords::View FrameRecords::view() const {
  View view;
  const std::lock_guard lock(mutex_);
  view.chunks_.assign(chunks_.begin(), chunks_.end());
  view.size_ = size_;
  view.newest_ = newest_;
  return view;
}

std::int64_t FrameRecords::size() const {
  const std::lock_guard lock(mutex_);
  return static_cast<std::int64_t>(size_ + (newest_ ? 1 : 0));
}

}  // namespace vsgraphs
