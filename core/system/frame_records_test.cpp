#include "core/system/frame_records.h"

#include <gtest/gtest.h>

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
