#include "core/system/maps/stage_guard.h"

#include <algorithm>

namespace vsgraphs {

bool StageGuard::is_off(const std::string& stage) const {
  return std::find(off_.begin(), off_.end(), stage) != off_.end();
}

void StageGuard::switch_off(const std::string& stage, const std::string& why) {
  off_.push_back(stage);
  warn(stage + " failed and was switched off, the run goes on without it: " + why +
       " (a defect: please report it)");
}

void StageGuard::warn(const std::string& line) {
  if (std::find(warnings_->begin(), warnings_->end(), line) != warnings_->end()) return;
  auto lines = std::make_shared<std::vector<std::string>>(*warnings_);
  lines->push_back(line);
  warnings_ = std::move(lines);
}

}  // namespace vsgraphs
