#include "core/base/atomic_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

class AtomicFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string content() const {
    const FileContent read = read_file(file_);
    return {reinterpret_cast<const char*>(read.data.get()), read.size};
  }
  std::string error_of(const std::string& text) const {
    try {
      write_file_atomically(file_, {bytes_of(text)});
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      ("atomic_file_test_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  std::filesystem::path file_ = folder_ / "a.bin";
};

TEST_F(AtomicFile, WritesPartsInTurnAndReplacesWhatWasThere) {
  write_file_atomically(file_, {bytes_of("one, "), {}, bytes_of("two")});
  EXPECT_EQ(content(), "one, two");
  write_file_atomically(file_, {bytes_of("3")});
  EXPECT_EQ(content(), "3");
  EXPECT_EQ(files(), 1U);
}

// The limit on a file's size stands for a full disk: both end a write in the middle.
TEST_F(AtomicFile, AFullDiskLeavesTheOldFile) {
  write_file_atomically(file_, {bytes_of("old")});
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 4096;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string error = error_of(std::string(100000, 'x'));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(error, "cannot write " + file_.string() + ": File too large");
  EXPECT_EQ(content(), "old");
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFile, WhatADeadProcessLeftIsTakenOver) {
  std::ofstream(folder_ / ".a.bin.part") << "half of something longer than what follows";
  EXPECT_EQ(error_of("new"), "");
  EXPECT_EQ(content(), "new");
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFile, ASecondWriterIsRefused) {
  write_file_atomically(file_, {bytes_of("old")});
  const int other = ::open((folder_ / ".a.bin.part").c_str(), O_WRONLY | O_CREAT, 0666);
  ASSERT_EQ(::flock(other, LOCK_EX), 0);
  EXPECT_THAT(error_of("new"), testing::HasSubstr("another program is writing it"));
  ::close(other);
  EXPECT_EQ(content(), "old");
}

TEST_F(AtomicFile, SaysWhatCannotBeWritten) {
  EXPECT_NO_THROW(require_writable(file_));
  EXPECT_EQ(files(), 0U);
  file_ = folder_;
  EXPECT_THAT(error_of("x"), testing::HasSubstr("it names a folder"));
  file_ = folder_ / "missing" / "a.bin";
  EXPECT_THAT(error_of("x"), testing::HasSubstr("there is no folder"));
  EXPECT_THROW(require_writable(file_), InputError);
  file_ = "/dev/full";
  EXPECT_THAT(error_of("x"), testing::HasSubstr("it is no ordinary file"));
}

TEST_F(AtomicFile, SaysWhatCannotBeRead) {
  EXPECT_THROW(read_file(file_), InputError);
  EXPECT_THROW(read_file(folder_), InputError);
  EXPECT_THROW(read_file("/dev/zero"), InputError);
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(read_file(folder_ / "pipe"), InputError);
  std::ofstream(file_).close();
  std::filesystem::resize_file(file_, std::uintmax_t{1} << 42);  // of holes
  EXPECT_THROW(read_file(file_), InputError);
  std::filesystem::resize_file(file_, 6);
  EXPECT_EQ(read_file(file_, 6).size, 6U);
  EXPECT_THROW(read_file(file_, 5), InputError);
}

}  // namespace
}  // namespace vsgraphs
