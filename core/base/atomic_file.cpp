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

std::filesystem::path kept(const std::filesystem::path& path, int number) {
  return path.string() + "." + std::to_string(number);
}

// Opens the part and holds its lock; what an earlier process left of it goes. `path` is for messages.
int open_part(const std::filesystem::path& path, const std::filesystem::path& end) {
  std::error_code ignored;
  const std::filesystem::path folder = folder_of(end);
  if (!path.has_filename() || std::filesystem::is_directory(path, ignored))
    cannot_write(path, "it names a folder; give a file");
  if (!std::filesystem::is_directory(folder, ignored))
    cannot_write(path, "there is no folder " + folder.string() + "; make it first");
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    cannot_write(path, "it is no ordinary file; give another name");
  const int file = ::open(part_of(end).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
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

// 0 or the error. Where a file system knows no hard links, or refuses this one.
int copy_to_disk(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code error;
  std::filesystem::copy_file(from, to, std::filesystem::copy_options::overwrite_existing, error);
  if (error) return error.value();
  const Descriptor copied(::open(to.c_str(), O_RDONLY | O_CLOEXEC));
  return copied.ok() && ::fsync(copied.number()) == 0 ? 0 : errno;
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  struct stat one{}, other{};
  return ::stat(a.c_str(), &one) == 0 && ::lstat(b.c_str(), &other) == 0 && one.st_dev == other.st_dev &&
         one.st_ino == other.st_ino;
}

// 0 or the error. What is there gets a second name and keeps its own until the rename that follows: at no moment is there none.
int keep_previous(const std::filesystem::path& file, int keep) {
  std::error_code ignored;
  const std::filesystem::path newest = kept(file, 1), beside = part_of(newest);
  // The same already: an earlier attempt came this far.
  if (keep <= 0 || !std::filesystem::exists(file, ignored) || same_file(file, newest)) return 0;
  ::unlink(beside.c_str());
  int error = ::link(file.c_str(), beside.c_str()) == 0 ? 0 : copy_to_disk(file, beside);
  int last = 1;  // what lies behind the first free number is not ours to move
  while (last < keep && std::filesystem::exists(kept(file, last), ignored)) ++last;
  for (int i = last; error == 0 && i > 1; --i) {
    if (::rename(kept(file, i - 1).c_str(), kept(file, i).c_str()) != 0 && errno != ENOENT) error = errno;
  }
  if (error == 0 && ::rename(beside.c_str(), newest.c_str()) != 0) error = errno;
  if (error != 0) ::unlink(beside.c_str());
  return error;
}

}  // namespace

std::filesystem::path followed(const std::filesystem::path& path) {
  constexpr int most_links = 40;  // as Linux has it
  std::filesystem::path end = path;
  std::error_code error;
  for (int i = 0; i < most_links; ++i) {
    if (!std::filesystem::is_symlink(end, error)) return end;
    const std::filesystem::path next = std::filesystem::read_symlink(end, error);
    if (error) return end;
    end = folder_of(end) / next;  // an absolute one replaces it
  }
  cannot_write(path, "its symbolic links lead in a circle");
}

void write_file_atomically(const std::filesystem::path& path,
                           const std::vector<std::span<const std::byte>>& parts, int keep) {
  const std::filesystem::path end = followed(path), part = part_of(end);
  const Descriptor file(open_part(path, end));
  int error = ::ftruncate(file.number(), 0) == 0 ? 0 : errno;
  for (const auto& bytes : parts) {
    if (error == 0) error = write_all(file.number(), bytes);
  }
  if (error == 0 && ::fsync(file.number()) != 0) error = errno;
  const int not_kept = error == 0 ? keep_previous(end, keep) : 0;
  if (error == 0 && not_kept == 0 && ::rename(part.c_str(), end.c_str()) != 0) error = errno;
  if (error != 0 || not_kept != 0) ::unlink(part.c_str());
  if (not_kept != 0)
    cannot_write(path, "what is there cannot be kept as " + kept(end, 1).string() + ": " + reason(not_kept));
  if (error != 0) cannot_write(path, reason(error));
  sync_folder(folder_of(end));
}

void require_writable(const std::filesystem::path& path) {
  const std::filesystem::path end = followed(path);
  const Descriptor file(open_part(path, end));
  ::unlink(part_of(end).c_str());
}

namespace {

std::string kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "it is a folder; give a file";
  if (S_ISFIFO(mode)) return "it is a pipe, not a regular file; save it as one and give that";
  return "it is no regular file";
}

}  // namespace

FileContent read_file(const std::filesystem::path& path, std::size_t limit, std::size_t most) {
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
  content.size = std::min(most, static_cast<std::size_t>(status.st_size));
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
