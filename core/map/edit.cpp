#include "core/map/edit.h"

#include <algorithm>
#include <cstring>

#include "core/base/field_writer.h"
#include "core/map/edit_fields.h"

namespace vsgraphs {

namespace {

// FNV-1a's step on words of eight bytes, the high half folded down after each. Shared constants by what they hold.
class HashSink {
 public:
  void bytes(const void* data, std::size_t count) {
    const auto* at = static_cast<const char*>(data);
    for (; count > 0; count -= std::min<std::size_t>(8, count), at += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, at, std::min<std::size_t>(8, count));
      hash_ = (hash_ ^ word) * 0x100000001b3ULL;
      hash_ ^= hash_ >> 32;
    }
  }
  template <typename T>
  void shared(const std::shared_ptr<const T>& value) {
    FieldWriter<HashSink> write(*this);
    write(value != nullptr);
    if (value) write(*value);
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

}  // namespace

std::uint64_t MapEdit::hash() const {
  HashSink hash;
  FieldWriter<HashSink> write(hash);
  write(based_on);
  for (const EditOperation& operation : operations) {
    write(static_cast<std::uint64_t>(operation.index()));
    std::visit([&write](const auto& op) { write(op); }, operation);
  }
  return hash.value();
}

}  // namespace vsgraphs
