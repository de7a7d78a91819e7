// Clocks for the stages: a sink that turns spans into a timeline and into statistics.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/trace.h"

namespace vsgraphs {

struct SpanRecord {
  const char* name;
  std::int64_t begin_us;  // since the process-wide steady clock's origin
  std::int64_t duration_us;
  float cpu_ms;  // of the thread that ran it
  float wall_ms;
  std::int64_t frame;
};

// One per thread ("lane"); not shared while spans are open. Memory is bounded: of a long run it keeps the spans of every second
// frame, then of every fourth, ...; how many there were and the longest are counted over all.
class SpanRecorder : public TraceSink {
 public:
  struct Total {
    std::int64_t count = 0;
    float longest_ms = 0;
  };
  // `capacity`: spans kept, 40 bytes each.
  explicit SpanRecorder(std::string lane, std::size_t capacity = 100'000)
      : lane_(std::move(lane)), capacity_(capacity) {}
  void set_frame(std::int64_t frame) { frame_ = frame; }
  void begin(const char* name) override;
  void end() override;

  const std::string& lane() const { return lane_; }
  const std::vector<SpanRecord>& spans() const { return spans_; }
  const std::map<std::string, Total>& totals() const { return totals_; }

 private:
  void thin_out();

  struct Open {
    const char* name;
    std::int64_t begin_ns, cpu_ns;
  };
  std::string lane_;
  std::size_t capacity_;
  std::int64_t every_ = 1;  // frames of which spans are kept
  std::map<std::string, Total> totals_;
  std::int64_t frame_ = 0;
  std::vector<Open> open_;
  std::vector<SpanRecord> spans_;
};

struct StageStatistics {
  std::int64_t count = 0;
  double median_ms = 0, p95_ms = 0, max_ms = 0;  // wall
  double cpu_median_ms = 0, cpu_p95_ms = 0;
};

std::map<std::string, StageStatistics> stage_statistics(const std::vector<const SpanRecorder*>& recorders);

}  // namespace vsgraphs
