#include "core/system/stage_guard.h"

#include <algorithm>

namespace vsgraphs {

bool StageGuard::is_off(const std::string& stage) const {
  return std::find(off_.begin(), off_.end(), stage) != off_.end();
}

void StageGuard::switch_off(const std::string& stage, const std::string& why) {
  off_.push_back(stage);
  auto lines = std::make_shared<std::vector<std::string>>(*warnings_);
  lines->push_back(stage + " failed and was switched off, the run goes on without it: " + why +
                   " (a defect: please report it)");
  warnings_ = std::move(lines);
}

}  // namespace vsgraphs
