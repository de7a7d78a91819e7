#include "core/system/run/scratch_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "core/base/check.h"

namespace vsgraphs {

std::shared_ptr<ScratchFile> ScratchFile::make() {
  std::error_code failed;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(failed);
  if (failed) return nullptr;
  std::string name = (folder / "vsgraphs-XXXXXX").string();
  const int file = mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) return nullptr;
  unlink(name.c_str());
  return std::make_shared<ScratchFile>(file);
}

ScratchFile::~ScratchFile() { close(file_); }

bool ScratchFile::write(std::size_t offset, const void* bytes, std::size_t size) {
  const auto* from = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t done = pwrite(file_, from, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    const auto written = static_cast<std::size_t>(done);
    from += written;
    offset += written;
    size -= written;
  }
  return true;
}

void ScratchFile::read(std::size_t offset, void* bytes, std::size_t size) const {
  auto* to = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t done = pread(file_, to, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0)
      throw RunError(std::string("what was written to the folder for temporary files cannot be read back: ") +
                     std::strerror(done < 0 ? errno : EIO));
    const auto got = static_cast<std::size_t>(done);
    to += got;
    offset += got;
    size -= got;
  }
}

}  // namespace vsgraphs
