#include "core/base/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <system_error>
#include <utility>

#include "core/base/check.h"

namespace vsgraphs {

namespace {

std::string reason(int error) { return std::generic_category().message(error); }

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }
  bool ok() const { return number_ >= 0; }

 private:
  int number_;
};

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

std::filesystem::path part_of(const std::filesystem::path& path) {
  std::string name(1, '.');
  name.append(path.filename().string()).append(".part");
  return folder_of(path) / name;
}

[[noreturn]] void cannot_write(const std::filesystem::path& path, const std::string& why) {
  throw InputError("cannot write " + path.string() + ": " + why);
}

// Opens the part and holds its lock; what an earlier process left of it goes.
int open_part(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::path folder = folder_of(path);
  if (!path.has_filename() || std::filesystem::is_directory(path, ignored))
    cannot_write(path, "it names a folder; give a file");
  if (!std::filesystem::is_directory(folder, ignored))
    cannot_write(path, "there is no folder " + folder.string() + "; make it first");
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    cannot_write(path, "it is no ordinary file; give another name");
  const int file = ::open(part_of(path).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file < 0) cannot_write(path, reason(errno));
  // Where a file system knows no locks there is none to wait for.
  if (::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(file);
    cannot_write(path, "another program is writing it; give another name");
  }
  return file;
}

// 0 or the error.
int write_all(int file, std::span<const std::byte> bytes) {
  constexpr std::size_t at_once = std::size_t{1} << 24;
  while (!bytes.empty()) {
    const ssize_t n = ::write(file, bytes.data(), std::min(at_once, bytes.size()));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    if (n == 0) return ENOSPC;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return 0;
}

// The name is on the disk once its folder is; some file systems refuse, and are none the worse for it.
void sync_folder(const std::filesystem::path& folder) {
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.ok()) ::fsync(opened.number());
}

}  // namespace

void write_file_atomically(const std::filesystem::path& path,
                           const std::vector<std::span<const std::byte>>& parts) {
  const Descriptor file(open_part(path));
  int error = ::ftruncate(file.number(), 0) == 0 ? 0 : errno;
  for (const auto& part : parts) {
    if (error == 0) error = write_all(file.number(), part);
  }
  if (error == 0 && ::fsync(file.number()) != 0) error = errno;
  if (error == 0 && ::rename(part_of(path).c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(part_of(path).c_str());
    cannot_write(path, reason(error));
  }
  sync_folder(folder_of(path));
}

void require_writable(const std::filesystem::path& path) {
  const Descriptor file(open_part(path));
  ::unlink(part_of(path).c_str());
}

namespace {

std::string kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "it is a folder; give a file";
  if (S_ISFIFO(mode)) return "it is a pipe, not a regular file; save it as one and give that";
  return "it is no regular file";
}

}  // namespace

FileContent read_file(const std::filesystem::path& path, std::size_t limit) {
  const auto fail = [&path](const std::string& why) {
    throw InputError("cannot read " + path.string() + ": " + why);
  };
  struct stat status{};
  if (::stat(path.c_str(), &status) != 0) fail(reason(errno));
  if (!S_ISREG(status.st_mode)) fail(kind_of(status.st_mode));  // not opened: a device may do something then
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.ok()) fail(reason(errno));
  if (::fstat(file.number(), &status) != 0) fail(reason(errno));
  if (!S_ISREG(status.st_mode)) fail(kind_of(status.st_mode));  // it may be another one by now
  FileContent content;
  content.size = static_cast<std::size_t>(status.st_size);
  if (content.size > limit)
    fail("it is larger than " + std::to_string(limit >> 20) + " MB; is it the right file?");
  try {
    content.data = std::make_unique_for_overwrite<std::byte[]>(content.size);
  } catch (const std::bad_alloc&) {
    fail("its " + std::to_string(content.size >> 20) + " MB find no room in memory; is it the right file?");
  }
  for (std::size_t at = 0; at < content.size;) {
    const ssize_t n = ::read(file.number(), content.data.get() + at, content.size - at);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(reason(errno));
    if (n == 0) fail("it became shorter while it was read");
    at += static_cast<std::size_t>(n);
  }
  return content;
}

}  // namespace vsgraphs
