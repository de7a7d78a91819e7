#include "core/system/maps/schedule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// A folder of the test's own, gone afterwards.
class ScheduleTest : public ::testing::Test {
 protected:
  ScheduleTest() { std::filesystem::create_directories(folder_); }
  ~ScheduleTest() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  // What reading a file of this text says is wrong; empty if nothing.
  std::string complaint(const std::string& text) const {
    const std::string file = path("schedule.txt");
    std::ofstream(file) << text;
    try {
      Schedule::read(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

  std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) /
      ("schedule_test_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
};

Schedule some_schedule() {
  Schedule schedule;
  // Stamps whose decimal text would not give them back.
  schedule.frames = {
      {0, 1.0 / 3.0, 0}, {1, std::nextafter(1305031102.1753, 0.0), 2}, {7, -0.0, 18446744073709551615U}};
  schedule.edits = {{EditEvent::Kind::insert, 0, 0, 0xffffffffffffffffU},
                    {EditEvent::Kind::planes, 0, 0, 7},
                    {EditEvent::Kind::refine, 0, 15, 0},
                    {EditEvent::Kind::labels, 0, 0, 0xabcdefU},
                    {EditEvent::Kind::markers, 0, 0, 0x1234U},
                    {EditEvent::Kind::insert, 7, 0, 10}};
  return schedule;
}

TEST_F(ScheduleTest, WhatIsWrittenIsReadBackToTheBit) {
  const Schedule written = some_schedule();
  written.write(path("schedule.txt"));
  const Schedule read = Schedule::read(path("schedule.txt"));
  EXPECT_EQ(read.edits, written.edits);
  ASSERT_EQ(read.frames.size(), written.frames.size());
  for (std::size_t i = 0; i < read.frames.size(); ++i) {
    EXPECT_EQ(read.frames[i].frame, written.frames[i].frame);
    EXPECT_EQ(read.frames[i].version, written.frames[i].version);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read.frames[i].timestamp_s),
              std::bit_cast<std::uint64_t>(written.frames[i].timestamp_s));
  }
}

TEST_F(ScheduleTest, TheFormatIsAsDescribed) {
  Schedule schedule;
  schedule.frames = {{3, 1.0, 12}};
  schedule.edits = {{EditEvent::Kind::insert, 3, 0, 255},
                    {EditEvent::Kind::planes, 3, 0, 254},
                    {EditEvent::Kind::labels, 1, 0, 253},
                    {EditEvent::Kind::refine, 3, 15, 16}};
  schedule.write(path("schedule.txt"));
  std::ifstream file(path("schedule.txt"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text, "frame 3 3ff0000000000000 12\ninsert 3 ff\nplanes 3 fe\nlabels 1 fd\nrefine 3 15 10\n");
}

TEST_F(ScheduleTest, AnOlderFileIsReplacedAndNothingElseLeft) {
  std::ofstream(path("schedule.txt"))
      << "an older file, much longer than the new one will be: " << std::string(500, 'x');
  some_schedule().write(path("schedule.txt"));
  EXPECT_EQ(Schedule::read(path("schedule.txt")).frames.size(), 3U);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(ScheduleTest, BadLinesAreNamed) {
  const std::string good = "frame 0 3ff0000000000000 0\n";
  EXPECT_EQ(complaint(good), "");
  EXPECT_THAT(complaint(good + "jump 1 2\n"), EndsWith("schedule.txt:2: not a line of a schedule"));
  for (const char* bad : {"frame",
                          "frame 1",
                          "frame 1 3ff",
                          "frame x 3ff 1",
                          "frame 1 3ff y",
                          "frame 1 zz 1",
                          "insert",
                          "insert 1",
                          "insert 1 xyz",
                          "refine 1 2",
                          "refine 1 x ff",
                          "",
                          "frame 1 3ff 1 7",
                          "insert 1 ff ff",
                          "refine 1 2 ff 3",
                          "frame 1 3ff 1x",
                          "insert 1 ffffffffffffffffff",
                          "planes 1",
                          "planes 1 2 ff",
                          "labels",
                          "labels 1 x",
                          "plane 1 ff"}) {
    EXPECT_THAT(complaint(good + good + bad + "\n" + good), HasSubstr("schedule.txt:3: "))
        << "line '" << bad << "'";
  }
}

TEST_F(ScheduleTest, FilesThatAreNoScheduleAreNamed) {
  EXPECT_THAT(complaint(""), HasSubstr("schedule.txt: holds no frames"));
  EXPECT_THAT(complaint("insert 0 ff\n"), HasSubstr("schedule.txt: holds no frames"));
  try {
    Schedule::read(path("missing.txt"));
    FAIL() << "a missing file was read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith("cannot read " + path("missing.txt")));
  }
}

TEST_F(ScheduleTest, WhereNothingCanBeWrittenTheFileIsNamed) {
  try {
    some_schedule().write(path("no_such_folder/schedule.txt"));
    FAIL() << "written into a folder that does not exist";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith("cannot write " + path("no_such_folder/schedule.txt")));
  }
}

TEST_F(ScheduleTest, AFolderInTheWayLeavesNoHalfFile) {
  std::filesystem::create_directories(path("schedule.txt/inside"));
  EXPECT_THROW(some_schedule().write(path("schedule.txt")), InputError);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(ScheduleTest, APipeIsNeitherWaitedForNorReplaced) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_THROW(Schedule::read(path("pipe")), InputError);
  EXPECT_THROW(some_schedule().write(path("pipe")), InputError);
  EXPECT_TRUE(std::filesystem::is_fifo(path("pipe")));
  EXPECT_THROW(Schedule::read("/dev/zero"), InputError);
}

}  // namespace
}  // namespace vsgraphs
