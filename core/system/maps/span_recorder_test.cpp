#include "core/system/maps/span_recorder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

TEST(SpanRecorder, SpansAreRecordedWithTheirFrameInnermostFirst) {
  SpanRecorder recorder("lane");
  recorder.set_frame(7);
  {
    const Span outer(&recorder, "outer");
    const Span inner(&recorder, "inner");
  }
  recorder.set_frame(8);
  {
    const Span next(&recorder, "next");
  }
  ASSERT_EQ(recorder.spans().size(), 3U);
  const SpanRecord &inner = recorder.spans()[0], &outer = recorder.spans()[1], &next = recorder.spans()[2];
  EXPECT_STREQ(inner.name, "inner");
  EXPECT_STREQ(outer.name, "outer");
  EXPECT_EQ(outer.frame, 7);
  EXPECT_EQ(next.frame, 8);
  EXPECT_EQ(recorder.lane(), "lane");
  // The inner one lies within the outer one, and that before the next.
  EXPECT_LE(outer.begin_us, inner.begin_us);
  EXPECT_LE(inner.wall_ms, outer.wall_ms);
  EXPECT_LE(outer.begin_us, next.begin_us);
}

TEST(SpanRecorder, WallAndProcessorTimeGoByWhileWorkIsDone) {
  SpanRecorder recorder("lane");
  {
    const Span span(&recorder, "work");
    volatile double sum = 0;
    for (int i = 0; i < 2'000'000; ++i) sum = sum + 1.0;
  }
  const SpanRecord& span = recorder.spans().front();
  EXPECT_GT(span.wall_ms, 0.1F);
  EXPECT_GT(span.cpu_ms, 0.1F);
  EXPECT_NEAR(static_cast<double>(span.duration_us), 1000.0 * static_cast<double>(span.wall_ms), 2.0);
}

TEST(SpanRecorder, AnEndWithoutABeginIsADefect) {
  SpanRecorder recorder("lane");
  EXPECT_THROW(recorder.end(), InvariantError);
}

TEST(SpanRecorder, StatisticsPoolTheLanesByName) {
  SpanRecorder first("a"), second("b");
  for (int i = 0; i < 5; ++i) {
    const Span span(&first, "shared");
    const Span own(&first, "own");
  }
  // Another text of the same letters is the same stage.
  const std::string same = std::string("sha") + "red";
  for (int i = 0; i < 3; ++i) const Span span(&second, same.c_str());
  const auto statistics = stage_statistics({&first, &second});
  ASSERT_EQ(statistics.size(), 2U);
  EXPECT_EQ(statistics.at("shared").count, 8);
  EXPECT_EQ(statistics.at("own").count, 5);
  double longest = 0;
  for (const SpanRecorder* lane : {&first, &second})
    for (const SpanRecord& span : lane->spans())
      if (std::string(span.name) == "shared") longest = std::max(longest, static_cast<double>(span.wall_ms));
  EXPECT_EQ(statistics.at("shared").max_ms, longest);
  EXPECT_EQ(statistics.at("shared").p95_ms, longest) << "95 % of 8 are the eighth, by nearest rank";
  EXPECT_LE(statistics.at("shared").median_ms, statistics.at("shared").p95_ms);
}

TEST(SpanRecorder, NoSpansNoStatistics) {
  const SpanRecorder recorder("lane");
  EXPECT_TRUE(stage_statistics({&recorder}).empty());
  EXPECT_TRUE(stage_statistics({}).empty());
}

TEST(SpanRecorder, ALongRunKeepsSpansOfFewerFramesAndCountsThemAll) {
  SpanRecorder recorder("lane", 64);
  for (int frame = 0; frame < 1000; ++frame) {
    recorder.set_frame(frame);
    for (const char* name : {"track", "match"}) {
      recorder.begin(name);
      recorder.end();
    }
  }
  EXPECT_LE(recorder.spans().size(), 64U);
  EXPECT_GT(recorder.spans().size(), 20U);
  EXPECT_EQ(recorder.spans().front().frame, 0) << "evenly over the whole run";
  EXPECT_GT(recorder.spans().back().frame, 900);
  EXPECT_EQ(stage_statistics({&recorder}).at("track").count, 1000);
}

TEST(SpanRecorder, ManySpansOfOneFrameAreBoundedToo) {
  SpanRecorder recorder("lane", 64);
  for (int i = 0; i < 1000; ++i) {
    recorder.begin("track");
    recorder.end();
  }
  EXPECT_LE(recorder.spans().size(), 64U);
}

}  // namespace
}  // namespace vsgraphs
