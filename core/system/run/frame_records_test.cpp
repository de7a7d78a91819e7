#include "core/system/run/frame_records.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace vsgraphs {
namespace {

FrameRecord record(std::int64_t index, KeyframeId keyframe = {3, 0}) {
  return {index, 0.1 * static_cast<double>(index), {keyframe, Se3{}}};
}

std::vector<std::int64_t> indices(const FrameRecords::View& view) {
  std::vector<std::int64_t> all;
  view.for_each([&all](const FrameRecord& r) { all.push_back(r.index); });
  return all;
}

TEST(FrameRecords, AreReadInOrderOverChunks) {
  FrameRecords records;
  EXPECT_EQ(records.view().size(), 0U);
  const std::int64_t count = 2 * FrameRecords::chunk_size + 7;
  for (std::int64_t i = 0; i < count; ++i) records.append(record(i));
  EXPECT_EQ(records.size(), count);
  const auto all = indices(records.view());
  ASSERT_EQ(std::ssize(all), count);
  for (std::int64_t i = 0; i < count; ++i) EXPECT_EQ(all[static_cast<std::size_t>(i)], i);
}

class FrameRecordsOfADay : public ::testing::Test {
 protected:
  static FrameRecord somewhere(std::int64_t i) {
    const double x = static_cast<double>(i);
    return {i,
            0.03 * x,
            {{static_cast<std::uint32_t>(i / 7), 1}, Se3(so3_exp({0.1 * x, 0.2, 0}), {x, 1 / (x + 1), 0.1})}};
  }
  static void expect_all(const FrameRecords::View& view, std::int64_t count) {
    std::int64_t at = 0;
    view.for_each([&at](const FrameRecord& r) {
      const FrameRecord right = somewhere(at++);
      ASSERT_EQ(r.index, right.index);
      ASSERT_EQ(r.timestamp_s, right.timestamp_s);
      ASSERT_EQ(r.pose.keyframe, right.pose.keyframe);
      ASSERT_EQ(r.pose.keyframe_from_camera.matrix(), right.pose.keyframe_from_camera.matrix());
    });
    EXPECT_EQ(at, count);
  }
  static constexpr std::int64_t count = (FrameRecords::chunks_in_memory + 5) * FrameRecords::chunk_size + 7;
};

TEST_F(FrameRecordsOfADay, AreReadFromTheFileAsTheyWere) {
  FrameRecords records;
  std::optional<FrameRecords::View> earlier;
  for (std::int64_t i = 0; i < count; ++i) {
    if (i == 3 * std::int64_t{FrameRecords::chunk_size}) earlier = records.view();
    records.append(somewhere(i));
  }
  EXPECT_EQ(records.chunks_in_file(), 6U);
  expect_all(records.view(), count);
  expect_all(*earlier, 3 * std::int64_t{FrameRecords::chunk_size});
}

TEST_F(FrameRecordsOfADay, StayInMemoryWhereNoFileCanBeMade) {
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before ? before : "";
  setenv("TMPDIR", "/nowhere/at/all", 1);
  FrameRecords records;
  for (std::int64_t i = 0; i < count; ++i) records.append(somewhere(i));
  before ? setenv("TMPDIR", kept.c_str(), 1) : unsetenv("TMPDIR");
  EXPECT_EQ(records.chunks_in_file(), 0U);
  expect_all(records.view(), count);
}

TEST(FrameRecords, AViewStaysWhatItWas) {
  FrameRecords records;
  records.append(record(0));
  records.append(record(1, KeyframeId{}));
  const FrameRecords::View before = records.view();
  records.name_newest({9, 0});
  records.append(record(2));
  EXPECT_EQ(indices(before), (std::vector<std::int64_t>{0, 1}));
  before.for_each([](const FrameRecord& r) { EXPECT_EQ(r.pose.keyframe.valid(), r.index == 0); });
  records.view().for_each([](const FrameRecord& r) { EXPECT_TRUE(r.pose.keyframe.valid()) << r.index; });
}

TEST(FrameRecords, OnlyTheNewestCanWaitForAName) {
  FrameRecords records;
  EXPECT_EQ(records.unnamed(), nullptr);
  records.append(record(0, KeyframeId{}));
  ASSERT_NE(records.unnamed(), nullptr);
  EXPECT_EQ(records.unnamed()->index, 0);
  records.name_newest({1, 0});
  EXPECT_EQ(records.unnamed(), nullptr);
}

}  // namespace
}  // namespace vsgraphs
