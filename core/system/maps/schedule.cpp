#include "core/system/maps/schedule.h"

#include <array>
#include <bit>
#include <iomanip>
#include <optional>
#include <span>
#include <sstream>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/check.h"

namespace vsgraphs {

namespace {

constexpr std::array<std::pair<const char*, EditEvent::Kind>, 14> kinds = {{
    {"insert", EditEvent::Kind::insert},
    {"planes", EditEvent::Kind::planes},
    {"labels", EditEvent::Kind::labels},
    {"roles", EditEvent::Kind::roles},
    {"markers", EditEvent::Kind::markers},
    {"rooms", EditEvent::Kind::rooms},
    {"rooms_last", EditEvent::Kind::rooms_last},
    {"loop", EditEvent::Kind::loop},
    {"adjust", EditEvent::Kind::adjust},
    {"refine", EditEvent::Kind::refine},
    {"new_map", EditEvent::Kind::new_map},
    {"resume", EditEvent::Kind::resume},
    {"join", EditEvent::Kind::join},
    {"settle", EditEvent::Kind::settle},
}};

constexpr std::size_t largest_file = std::size_t{1} << 30;

std::optional<EditEvent::Kind> kind_named(const std::string& name) {
  for (const auto& [text, kind] : kinds) {
    if (name == text) return kind;
  }
  return std::nullopt;
}

const char* name_of(EditEvent::Kind kind) { return kinds[static_cast<std::size_t>(kind)].first; }

}  // namespace

Schedule Schedule::read(const std::string& path) {
  const FileContent content = read_file(path, largest_file);
  std::istringstream file(std::string(reinterpret_cast<const char*>(content.data.get()), content.size));
  Schedule schedule;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream in(line);
    std::string what;
    in >> what;
    bool ok = true;
    if (what == "frame") {
      FrameEvent e;
      std::uint64_t stamp_bits = 0;
      ok = static_cast<bool>(in >> e.frame >> std::hex >> stamp_bits >> std::dec >> e.version);
      e.timestamp_s = std::bit_cast<double>(stamp_bits);
      schedule.frames.push_back(e);
    } else if (const auto kind = kind_named(what)) {
      EditEvent e;
      e.kind = *kind;
      ok = static_cast<bool>(in >> e.frame);
      if (e.iterates()) ok = ok && static_cast<bool>(in >> e.iterations);
      ok = ok && static_cast<bool>(in >> std::hex >> e.hash);
      schedule.edits.push_back(e);
    } else {
      ok = false;
    }
    ok = ok && (in >> std::ws).eof();
    require_input(ok, path + ":" + std::to_string(number) + ": not a line of a schedule");
  }
  require_input(!schedule.frames.empty(), path + ": holds no frames; it is not a recorded schedule");
  return schedule;
}

void Schedule::write(const std::string& path) const {
  std::ostringstream out;
  for (const FrameEvent& e : frames) {
    out << "frame " << e.frame << ' ' << std::hex << std::bit_cast<std::uint64_t>(e.timestamp_s) << std::dec
        << ' ' << e.version << '\n';
  }
  for (const EditEvent& e : edits) {
    out << name_of(e.kind) << ' ' << e.frame;
    if (e.iterates()) out << ' ' << e.iterations;
    out << ' ' << std::hex << e.hash << std::dec << '\n';
  }
  const std::string text = out.str();
  write_file_atomically(path, {std::as_bytes(std::span(text))});
}

}  // namespace vsgraphs
