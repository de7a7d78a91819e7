#include "core/base/atomic_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <thread>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

class AtomicFile : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(folder_);  // of a run that was killed
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string content() const { return content_of(file_); }
  static std::string content_of(const std::filesystem::path& path) {
    const FileContent read = read_file(path);
    return {reinterpret_cast<const char*>(read.data.get()), read.size};
  }
  // What is kept of earlier versions.
  std::string kept(int number) const { return content_of(file_.string() + "." + std::to_string(number)); }
  void write(const std::string& text, int keep = 0) const {
    write_file_atomically(file_, {bytes_of(text)}, keep);
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

TEST_F(AtomicFile, KeepsAsManyPreviousVersionsAsAsked) {
  write("one", 2);
  EXPECT_EQ(files(), 1U);  // nothing was there
  write("two", 2);
  write("three", 2);
  write("four", 2);
  EXPECT_EQ(content(), "four");
  EXPECT_EQ(kept(1), "three");
  EXPECT_EQ(kept(2), "two");
  EXPECT_EQ(files(), 3U);
  write("five");
  write("six", 1);
  EXPECT_EQ(kept(1), "five");
  EXPECT_EQ(kept(2), "two") << "beyond those asked for nothing is touched";
}

// Seen from elsewhere: whoever reads while versions are turned over finds a whole one under the file's own name.
TEST_F(AtomicFile, ThereIsAlwaysAWholeFile) {
  const std::string one(1 << 16, '1'), two(1 << 16, '2');
  write(one, 3);
  std::atomic<bool> stop = false, whole = true;
  std::thread reader([&] {
    while (!stop) {
      try {
        const std::string seen = content();
        if (seen != one && seen != two) whole = false;
      } catch (const InputError&) {
        whole = false;
      }
    }
  });
  for (int i = 0; i < 40; ++i) write(i % 2 ? one : two, 3);
  stop = true;
  reader.join();
  EXPECT_TRUE(whole);
}

TEST_F(AtomicFile, WhatADeadProcessLeftWhileKeepingIsTakenOver) {
  write("one");
  std::filesystem::create_hard_link(file_, folder_ / ".a.bin.1.part");  // it died before the last rename
  write("two", 1);
  EXPECT_EQ(kept(1), "one");
  std::filesystem::remove(file_.string() + ".1");
  std::filesystem::create_hard_link(file_, file_.string() + ".1");  // it died after it
  write("older", 0);
  std::filesystem::remove(file_);
  std::filesystem::create_hard_link(file_.string() + ".1", file_);
  std::ofstream(file_.string() + ".2") << "zero";
  write("three", 2);
  EXPECT_EQ(kept(1), "two");
  EXPECT_EQ(kept(2), "zero") << "what is kept already is not kept twice";
  EXPECT_EQ(files(), 3U);
}

TEST_F(AtomicFile, WhereTheOldCannotBeKeptItStays) {
  write("old");
  std::filesystem::create_directories(file_.string() + ".1/x");
  try {
    write("new", 1);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("a.bin.1: Is a directory"));
  }
  EXPECT_EQ(content(), "old");
  EXPECT_EQ(files(), 2U);
}

TEST_F(AtomicFile, ALinkIsFollowedAndStays) {
  const std::filesystem::path real = folder_ / "elsewhere" / "real.bin", link = folder_ / "link",
                              far = folder_ / "far";
  std::filesystem::create_directories(real.parent_path());
  std::filesystem::create_symlink("elsewhere/real.bin", link);  // as seen from the link's folder
  std::filesystem::create_symlink(std::filesystem::absolute(link), far);
  file_ = far;
  EXPECT_NO_THROW(require_writable(file_));
  write("made where the link led");
  EXPECT_EQ(content_of(real), "made where the link led");
  write("new", 1);
  EXPECT_EQ(content_of(real), "new");
  EXPECT_EQ(content_of(real.string() + ".1"), "made where the link led");
  EXPECT_TRUE(std::filesystem::is_symlink(link) && std::filesystem::is_symlink(far));
  EXPECT_EQ(files(), 3U);
  EXPECT_EQ(followed(far).lexically_normal(), std::filesystem::absolute(real).lexically_normal());
}

TEST_F(AtomicFile, LinksInACircleAreAnError) {
  std::filesystem::create_symlink("b", folder_ / "a.bin");
  std::filesystem::create_symlink("a.bin", folder_ / "b");
  EXPECT_THAT(error_of("x"), testing::HasSubstr("lead in a circle"));
  EXPECT_THROW(require_writable(file_), InputError);
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

TEST_F(AtomicFile, ReadsABeginning) {
  write("0123456789");
  EXPECT_EQ(read_file(file_, SIZE_MAX, 4).size, 4U);
  EXPECT_EQ(read_file(file_, SIZE_MAX, 40).size, 10U);
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
