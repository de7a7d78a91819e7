#include "core/base/archive.h"

#include <utility>

#include "core/base/check.h"

namespace vsgraphs {

namespace {

constexpr std::size_t fixed_header = identity_bytes;
constexpr std::size_t checked_header = 16;  // of it, in front of its checksum

std::uint64_t step(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x100000001b3ULL;
  return hash ^ (hash >> 32);
}

template <typename T>
T number_at(std::span<const std::byte> bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t start) {
  std::uint64_t hash = step(start, bytes.size());
  std::size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) hash = step(hash, number_at<std::uint64_t>(bytes, at));
  std::uint64_t last = 0;
  if (at < bytes.size()) std::memcpy(&last, bytes.data() + at, bytes.size() - at);
  return step(hash, last);
}

std::uint64_t archive_identity(std::span<const std::byte> beginning) {
  return beginning.size() < fixed_header ? 0 : number_at<std::uint64_t>(beginning, checked_header);
}

Bytes ArchiveWriter::header() const {
  ByteSink table;
  FieldWriter<ByteSink> write(table);
  write(static_cast<std::uint32_t>(sections_.size()));
  for (const Section& section : sections_) {
    write(static_cast<std::uint32_t>(section.name.size()));
    table.bytes(section.name.data(), section.name.size());
    write(static_cast<std::uint64_t>(section.bytes.size()), checksum(section.bytes));
  }
  VSG_INVARIANT(kind_.magic.size() == 8);
  ByteSink header;
  FieldWriter<ByteSink> put(header);
  header.bytes(kind_.magic.data(), kind_.magic.size());
  put(kind_.version, static_cast<std::uint32_t>(table.content().size()));
  put(checksum(table.content(), checksum(header.content())));
  header.bytes(table.content().data(), table.content().size());
  return header.take();
}

std::vector<std::span<const std::byte>> ArchiveWriter::finish() {
  pools_.for_each([this](const std::string& name, std::uint32_t count, Bytes values) {
    ByteSink sink;
    FieldWriter<ByteSink>{sink}(static_cast<std::uint64_t>(count));
    sink.bytes(values.data(), values.size());
    add_bytes(ArchiveReader::shared_section(name), sink.take());
  });
  header_ = header();
  std::vector<std::span<const std::byte>> parts{header_};
  for (const Section& section : sections_) parts.emplace_back(section.bytes);
  return parts;
}

ArchiveReader::ArchiveReader(std::string file, std::span<const std::byte> bytes, const ArchiveKind& kind)
    : file_(std::move(file)), what_(kind.what) {
  const bool kindred = bytes.size() >= kind.magic.size() &&
                       std::memcmp(bytes.data(), kind.magic.data(), kind.magic.size()) == 0;
  require_input(kindred || bytes.empty(),
                file_ + ": is no vsgraphs " + what_ + "; give a file that vsgraphs saved");
  if (bytes.size() < fixed_header) damaged("it ends too early");
  version_ = number_at<std::uint32_t>(bytes, 8);
  const std::size_t rest = number_at<std::uint32_t>(bytes, 12);
  if (rest > bytes.size() - fixed_header) damaged("it ends too early");
  identity_ = archive_identity(bytes);
  const auto table = bytes.subspan(fixed_header, rest);
  if (checksum(table, checksum(bytes.first(checked_header))) != identity_) damaged("its header has changed");
  require_input(version_ <= kind.version, file_ + ": was saved in version " + std::to_string(version_) +
                                              " of the " + what_ +
                                              " format, and this vsgraphs reads up to version " +
                                              std::to_string(kind.version) + "; update vsgraphs");
  FieldReader reader(table, nullptr, [this](const std::string& what) { damaged("its header: " + what); });
  read_table(reader, bytes.subspan(fixed_header + rest));
}

void ArchiveReader::read_table(FieldReader& table, std::span<const std::byte> payload) {
  std::uint32_t count = 0;
  table(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t length = 0;
    table(length);
    table.require(length <= table.left(), "a name exceeds it");
    std::string name(length, '\0');
    for (char& c : name) table(c);
    std::uint64_t size = 0, sum = 0;
    table(size, sum);
    if (size > payload.size()) damaged("it ends too early");
    const auto section = payload.first(static_cast<std::size_t>(size));
    payload = payload.subspan(section.size());
    if (checksum(section) != sum) damaged("section '" + name + "' has changed");
    if (!sections_.emplace(name, section).second) damaged("section '" + name + "' is there twice");
  }
  table.require(table.left() == 0, "something follows its end");
  if (!payload.empty()) damaged("something follows its end");
}

std::vector<std::string> ArchiveReader::names() const {
  std::vector<std::string> all;
  for (const auto& [name, bytes] : sections_) all.push_back(name);
  return all;
}

std::span<const std::byte> ArchiveReader::section(const std::string& name) const {
  const auto found = sections_.find(name);
  if (found == sections_.end()) damaged("section '" + name + "' is missing");
  return found->second;
}

FieldReader ArchiveReader::reader(const std::string& name) const {
  return {section(name), &shared_,
          [this, name](const std::string& what) { damaged("section '" + name + "': " + what); }, version_};
}

void ArchiveReader::damaged(const std::string& what) const {
  throw InputError(file_ + ": is damaged (" + what + "); take a copy that is whole, or map anew");
}

}  // namespace vsgraphs
