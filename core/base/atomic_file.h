// Files that nobody ever sees half of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vsgraphs {

// Writes the parts one after the other beside `path` (as .NAME.part, locked against a second writer), has them reach the
// disk, and renames. A process that dies meanwhile leaves the old file and at most that one part. A symbolic link is
// followed, and stays. The newest `keep` previous versions stay as NAME.1 (the last one), NAME.2, ...; others of such names are
// not touched. Throws InputError naming the file and the cause (no space, no permission, a folder that is missing); the old
// file then stays.
void write_file_atomically(const std::filesystem::path& path,
                           const std::vector<std::span<const std::byte>>& parts, int keep = 0);

// The file that is written for `path`: where symbolic links lead, whether anything is there or not. Throws InputError where
// they lead in a circle.
std::filesystem::path followed(const std::filesystem::path& path);

// Throws what write_file_atomically() would throw for want of a folder, of permission, or because something else than a
// file has that name; writes nothing that stays.
void require_writable(const std::filesystem::path& path);

struct FileContent {
  std::unique_ptr<std::byte[]> data;
  std::size_t size = 0;
  std::span<const std::byte> bytes() const { return {data.get(), size}; }
};

// Beyond this no file is read: 64 GB.
inline constexpr std::size_t largest_readable = std::size_t{1} << 36;
// All of a regular file of at most `limit` bytes, or the first `most` of it; anything else is refused without waiting for it.
// Throws InputError naming it and what is wrong.
FileContent read_file(const std::filesystem::path& path, std::size_t limit = largest_readable,
                      std::size_t most = SIZE_MAX);

}  // namespace vsgraphs
