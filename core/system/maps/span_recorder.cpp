#include "core/system/maps/span_recorder.h"

#include <time.h>

#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace vsgraphs {

namespace {

std::int64_t now_ns(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

// Nearest-rank percentile; `values` is reordered.
double percentile(std::vector<float>& values, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const std::size_t index = std::min(values.size() - 1, rank > 0 ? rank - 1 : 0);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(index), values.end());
  return static_cast<double>(values[index]);
}

}  // namespace

void SpanRecorder::begin(const char* name) {
  open_.push_back({name, now_ns(CLOCK_MONOTONIC), now_ns(CLOCK_THREAD_CPUTIME_ID)});
}

void SpanRecorder::end() {
  VSG_INVARIANT(!open_.empty());
  const Open open = open_.back();
  open_.pop_back();
  const std::int64_t wall = now_ns(CLOCK_MONOTONIC) - open.begin_ns;
  const std::int64_t cpu = now_ns(CLOCK_THREAD_CPUTIME_ID) - open.cpu_ns;
  const float wall_ms = static_cast<float>(wall) * 1e-6f;
  Total& total = totals_[open.name];
  ++total.count;
  total.longest_ms = std::max(total.longest_ms, wall_ms);
  if (frame_ % every_ != 0) return;
  spans_.push_back(
      {open.name, open.begin_ns / 1000, wall / 1000, static_cast<float>(cpu) * 1e-6f, wall_ms, frame_});
  if (spans_.size() > capacity_) thin_out();
}

void SpanRecorder::thin_out() {
  every_ *= 2;
  std::erase_if(spans_, [this](const SpanRecord& span) { return span.frame % every_ != 0; });
  // Where all were of frames that stay, the older half goes.
  if (spans_.size() > capacity_)
    spans_.erase(spans_.begin(), spans_.begin() + static_cast<std::ptrdiff_t>(spans_.size() / 2));
}

std::map<std::string, StageStatistics> stage_statistics(const std::vector<const SpanRecorder*>& recorders) {
  struct Samples {
    std::vector<float> wall, cpu;
  };
  std::map<std::string, Samples> samples;
  for (const SpanRecorder* recorder : recorders) {
    for (const SpanRecord& span : recorder->spans()) {
      Samples& s = samples[span.name];
      s.wall.push_back(span.wall_ms);
      s.cpu.push_back(span.cpu_ms);
    }
  }
  std::map<std::string, StageStatistics> result;
  for (auto& [name, s] : samples) {
    StageStatistics& out = result[name];
    out.median_ms = percentile(s.wall, 0.5);
    out.p95_ms = percentile(s.wall, 0.95);
    out.cpu_median_ms = percentile(s.cpu, 0.5);
    out.cpu_p95_ms = percentile(s.cpu, 0.95);
  }
  for (const SpanRecorder* recorder : recorders) {
    for (const auto& [name, total] : recorder->totals()) {
      StageStatistics& out = result[name];
      out.count += total.count;
      out.max_ms = std::max(out.max_ms, static_cast<double>(total.longest_ms));
    }
  }
  return result;
}

}  // namespace vsgraphs
