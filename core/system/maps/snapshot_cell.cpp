#include "core/system/maps/snapshot_cell.h"

namespace vsgraphs {

void SnapshotCell::publish(Content content) {
  const std::lock_guard lock(mutex_);
  std::swap(content_, content);  // the old one's last owner may be this: it goes after the lock
  changed_.notify_all();
}

SnapshotCell::Content SnapshotCell::take() const {
  const std::lock_guard lock(mutex_);
  return content_;
}

void SnapshotCell::wait_for_inserted(std::int64_t count) const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this, count] { return closed_ || content_.inserted >= count; });
}

void SnapshotCell::wait_for_completed(std::int64_t count) const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this, count] { return closed_ || content_.completed >= count; });
}

void SnapshotCell::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

}  // namespace vsgraphs
