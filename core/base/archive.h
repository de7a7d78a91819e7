// A file of named sections, each with its checksum: what it holds comes back as it was, or an error says that it cannot.
//
//   bytes 0..7    magic of the kind of file
//   8..11         version of its format
//   12..15        size of the header's rest, n
//   16..23        checksum of bytes 0..15 and of the rest: the first 24 bytes mean this in every version
//   24..24+n      table: number of sections (4), then of each: name (4 + length), size (8), checksum (8)
//   then          the sections' bytes, in the order of the table, without gaps, up to the file's end
//
// Numbers are little-endian. Values are written by their fields (fields.h). The checksum is FNV-1a's step (Fowler, Noll,
// Vo, 1991) on words of eight bytes, with the high half folded down after each: every step is a bijection, so a single word
// that differs is always noticed.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/field_reader.h"
#include "core/base/shared_pool.h"

namespace vsgraphs {

std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t start = 0xcbf29ce484222325ULL);

// The header's checksum, which depends on that of every section: the same for the same content, another for any other. Told by the
// first `identity_bytes` of a file; 0 if there are fewer.
inline constexpr std::size_t identity_bytes = 24;
std::uint64_t archive_identity(std::span<const std::byte> beginning);

struct ArchiveKind {
  std::string_view magic;     // 8 characters
  std::uint32_t version = 1;  // the newest this program reads, and the one it writes
  std::string_view what;      // for messages: "atlas"
};

class ArchiveWriter {
 public:
  explicit ArchiveWriter(const ArchiveKind& kind) : kind_(kind), pools_(kind.version) {}

  // Shared constants among the values must live until the last call of a member function.
  template <typename... T>
  void add(const std::string& name, const T&... values) {
    ByteSink sink(&pools_);
    FieldWriter<ByteSink> write(sink, kind_.version);
    write(values...);
    add_bytes(name, sink.take());
  }
  void add_bytes(const std::string& name, Bytes bytes) { sections_.push_back({name, std::move(bytes)}); }

  // The file, in parts; the last call. Each part lives as long as the writer.
  std::vector<std::span<const std::byte>> finish();

 private:
  struct Section {
    std::string name;
    Bytes bytes;
  };
  Bytes header() const;

  ArchiveKind kind_;
  SharedPools pools_;
  std::vector<Section> sections_;
  Bytes header_;
};

// Reads from memory that it does not own and that must outlive it. Whatever the bytes are, each function gives what was
// written or throws InputError, one line that names the file.
class ArchiveReader {
 public:
  // Checks the header and all checksums, and that nothing is missing at the end or follows it. `file` is for messages.
  ArchiveReader(std::string file, std::span<const std::byte> bytes, const ArchiveKind& kind);

  std::uint32_t version() const { return version_; }
  std::uint64_t identity() const { return identity_; }
  std::vector<std::string> names() const;
  bool has(const std::string& name) const { return sections_.contains(name); }
  std::span<const std::byte> section(const std::string& name) const;

  // Makes the shared constants of a type known; before values that refer to them are read.
  template <typename T>
  void load_shared() {
    const std::string name = shared_section(shared_name<T>);
    std::vector<std::shared_ptr<const T>> values;
    if (has(name)) {
      FieldReader read = reader(name);
      const auto bytes_each = least_bytes<T>();
      const std::size_t n = read.count(bytes_each);
      for (std::size_t i = 0; i < n; ++i) {
        auto value = std::make_shared<T>();
        read(*value);
        values.push_back(std::move(value));
      }
      read.require(read.left() == 0, "something follows its end");
    }
    shared_.set<T>(std::move(values));
  }
  template <typename... T>
  void read(const std::string& name, T&... values) const {
    FieldReader read = reader(name);
    read(values...);
    read.require(read.left() == 0, "something follows its end");
  }

  // For what only the reader of the values can tell.
  [[noreturn]] void damaged(const std::string& what) const;

  static std::string shared_section(const std::string& name) { return "shared/" + name; }

 private:
  FieldReader reader(const std::string& name) const;
  void read_table(FieldReader& table, std::span<const std::byte> payload);

  std::string file_;
  std::string what_;
  std::uint32_t version_ = 0;
  std::uint64_t identity_ = 0;
  std::map<std::string, std::span<const std::byte>> sections_;
  SharedConstants shared_;
};

}  // namespace vsgraphs
