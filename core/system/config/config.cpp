#include "core/system/config/config.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>

#include "core/base/check.h"

namespace vsgraphs {

namespace {

// Puts a group's name before the names its describe function gives.
template <typename Visitor>
class Group {
 public:
  Group(std::string prefix, Visitor& visitor) : prefix_(std::move(prefix)), visitor_(visitor) {}
  template <typename... Args>
  void operator()(const char* name, Args&&... args) {
    visitor_(prefix_ + "." + name, std::forward<Args>(args)...);
  }

 private:
  std::string prefix_;
  Visitor& visitor_;
};

template <typename Options, typename Visitor>
void describe_group(const char* prefix, Options& options, Visitor& visitor) {
  Group<Visitor> group(prefix, visitor);
  describe(options, group);
}

// Levenshtein, "Binary codes capable of correcting deletions, insertions, and reversals" (1966).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row[b.size()];
}

std::string text_of(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e15)
    return std::to_string(static_cast<long long>(value));
  std::string text = std::to_string(value);
  while (text.back() == '0') text.pop_back();
  return text;
}

struct Collect {
  std::vector<OptionDescription> found;
  void operator()(const std::string& key, int& v, int low, int high, const char* meaning) {
    found.push_back(
        {key, std::int64_t{v}, {}, static_cast<double>(low), static_cast<double>(high), {}, meaning});
  }
  void operator()(const std::string& key, double& v, double low, double high, const char* meaning) {
    found.push_back({key, v, {}, low, high, {}, meaning});
  }
  void operator()(const std::string& key, bool& v, const char* meaning) {
    found.push_back({key, v, {}, 0, 0, {}, meaning});
  }
  void operator()(const std::string& key, std::string& v, const AllowedValues& allowed, const char* meaning) {
    found.push_back({key, v, {}, 0, 0, allowed, meaning});
  }
};

struct Assign {
  const std::string& key;
  const OptionValue& value;
  bool done = false;

  [[noreturn]] void wrong(const std::string& expected) const {
    throw InputError("option '" + key + "' must be " + expected);
  }
  std::string range(double low, double high) const { return text_of(low) + " to " + text_of(high); }

  void operator()(const std::string& k, int& v, int low, int high, const char*) {
    if (k != key) return;
    const auto* number = std::get_if<std::int64_t>(&value);
    if (!number || *number < low || *number > high) wrong("a whole number from " + range(low, high));
    v = static_cast<int>(*number);
    done = true;
  }
  void operator()(const std::string& k, double& v, double low, double high, const char*) {
    if (k != key) return;
    const auto* whole = std::get_if<std::int64_t>(&value);
    const auto* real = std::get_if<double>(&value);
    if (!whole && !real) wrong("a number from " + range(low, high));
    const double number = whole ? static_cast<double>(*whole) : *real;
    if (!(number >= low && number <= high)) wrong("a number from " + range(low, high));
    v = number;
    done = true;
  }
  void operator()(const std::string& k, bool& v, const char*) {
    if (k != key) return;
    const auto* flag = std::get_if<bool>(&value);
    if (!flag) wrong("true or false");
    v = *flag;
    done = true;
  }
  void operator()(const std::string& k, std::string& v, const AllowedValues& allowed, const char*) {
    if (k != key) return;
    const auto* text = std::get_if<std::string>(&value);
    if (!text) wrong("a text");
    if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), *text) == allowed.end()) {
      std::string list;
      for (const std::string& a : allowed) list += (list.empty() ? "" : ", ") + a;
      wrong("one of: " + list);
    }
    v = *text;
    done = true;
  }
};

}  // namespace

template <typename Visitor>
void Config::visit(Visitor&& visitor) {
  describe_group("system", system, visitor);
  describe_group("orb", orb, visitor);
  describe_group("tracker", tracker, visitor);
  describe_group("tracker.keyframe", tracker.keyframe, visitor);
  describe_group("tracker.recovery", tracker.recovery, visitor);
  describe_group("mapper", mapper, visitor);
  describe_group("mapper.culling", mapper.culling, visitor);
  describe_group("scene", scene, visitor);
  describe_group("scene.extraction", scene.extraction, visitor);
  describe_group("scene.association", scene.association, visitor);
  describe_group("scene.role", scene.role, visitor);
  describe_group("factors", factors, visitor);
  describe_group("loop", loop, visitor);
  describe_group("loop.alignment", loop.alignment, visitor);
  describe_group("loop.checks", loop.checks, visitor);
  describe_group("loop.drift", loop.drift, visitor);
  describe_group("loop.correction", loop.correction, visitor);
  describe_group("places", places, visitor);
  describe_group("structure", structure, visitor);
  describe_group("structure.free_space", structure.free_space, visitor);
  describe_group("structure.level", structure.structure.level, visitor);
  describe_group("structure.opening", structure.structure.opening, visitor);
  describe_group("structure.cluster", structure.structure.cluster, visitor);
  describe_group("structure.outline", structure.structure.outline, visitor);
  describe_group("structure.room", structure.structure.room, visitor);
  describe_group("structure.door", structure.structure.door, visitor);
  describe_group("structure.floor", structure.structure.floor, visitor);
  describe_group("structure.place", structure.structure.place, visitor);
}

void Config::set(const std::string& key, const OptionValue& value) {
  Assign assign{key, value};
  visit(assign);
  if (assign.done) return;
  std::string nearest;
  std::size_t least = key.size() + 1;
  for (const OptionDescription& option : describe_all()) {
    const std::size_t distance = edit_distance(key, option.key);
    if (distance < least) {
      least = distance;
      nearest = option.key;
    }
  }
  throw InputError("unknown option '" + key + "'; did you mean '" + nearest +
                   "'? (`vsgraphs config` lists all)");
}

OptionValue Config::get(const std::string& key) const {
  for (const OptionDescription& option : describe_all()) {
    if (option.key == key) return option.value;
  }
  throw InputError("unknown option '" + key + "' (`vsgraphs config` lists all)");
}

std::vector<OptionDescription> Config::describe_all() const {
  Config copy = *this, fresh;
  Collect now, defaults;
  copy.visit(now);
  fresh.visit(defaults);
  for (std::size_t i = 0; i < now.found.size(); ++i) now.found[i].default_value = defaults.found[i].value;
  return now.found;
}

bool stops_on_fault_by_default() {
#ifdef VSGRAPHS_STOP_ON_FAULT
  return true;
#else
  return false;
#endif
}

void Config::validate() const {
  // Fields are public: what was not set through set() is held to the same ranges.
  Config checked;
  for (const OptionDescription& option : describe_all()) checked.set(option.key, option.value);
  orb.validate();
  require_input(system.replay.empty() || system.schedule_out.empty(),
                "system.replay and system.schedule_out exclude each other");
}

}  // namespace vsgraphs
