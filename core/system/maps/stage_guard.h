// Faults stay where they happen: a part of mapping that fails is switched off, and tracking goes on without it.
#pragma once

#include <exception>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace vsgraphs {

class StageGuard {
 public:
  // `stops`: an exception goes on to who called instead.
  explicit StageGuard(bool stops) : stops_(stops) {}

  // Does the work, unless `stage` was switched off. False where it was, or has just failed; the work must then have changed
  // nothing that others see.
  template <typename Work>
  bool run(const char* stage, Work&& work) {
    if (is_off(stage)) return false;
    try {
      std::forward<Work>(work)();
      return true;
    } catch (const std::bad_alloc&) {
      throw;  // no defect of this part
    } catch (const std::exception& error) {
      if (stops_) throw;
      switch_off(stage, error.what());
      return false;
    }
  }

  bool is_off(const std::string& stage) const;
  // Adds a line to the warnings, once.
  void warn(const std::string& line);
  // One line per stage that is off, and those of warn(); never null. Made anew when there is one more.
  const std::shared_ptr<const std::vector<std::string>>& warnings() const { return warnings_; }

 private:
  void switch_off(const std::string& stage, const std::string& why);

  bool stops_;
  std::vector<std::string> off_;
  std::shared_ptr<const std::vector<std::string>> warnings_ =
      std::make_shared<const std::vector<std::string>>();
};

}  // namespace vsgraphs
