// Values kept as bytes. Constants that several owners share (std::shared_ptr<const T>) are written once, in a pool by
// type, and referred to by number, so that what was shared before saving is shared after loading.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/base/check.h"
#include "core/base/field_writer.h"

namespace vsgraphs {

using Bytes = std::vector<std::byte>;

class SharedPools;

// Collects bytes. `pools` is where shared constants go; a value that holds none needs no pools.
class ByteSink {
 public:
  explicit ByteSink(SharedPools* pools = nullptr) : pools_(pools) {}
  void bytes(const void* data, std::size_t count) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + count);
    if (count > 0) std::memcpy(bytes_.data() + at, data, count);
  }
  template <typename T>
  void shared(const std::shared_ptr<const T>& value);
  const Bytes& content() const { return bytes_; }
  Bytes take() { return std::move(bytes_); }

 private:
  SharedPools* pools_;
  Bytes bytes_;
};

class SharedPools {
 public:
  static constexpr std::uint32_t none = 0xffffffff;  // the number of a null pointer

  // `version`: of the format that is written.
  explicit SharedPools(std::uint32_t version = UINT32_MAX) : version_(version) {}

  // The value must live as long as the pools.
  template <typename T>
  std::uint32_t number_of(const std::shared_ptr<const T>& value) {
    static_assert(shared_name<T> != nullptr, "name the shared type beside it");
    if (!value) return none;
    Pool& pool = pools_[shared_name<T>];
    const auto [at, added] =
        pool.numbers.try_emplace(value.get(), static_cast<std::uint32_t>(pool.numbers.size()));
    if (added) FieldWriter<ByteSink>{pool.values, version_}(*value);
    return at->second;
  }
  // Calls add(name, count, bytes of all values) per pool, by name.
  template <typename Add>
  void for_each(Add&& add) {
    for (auto& [name, pool] : pools_)
      add(name, static_cast<std::uint32_t>(pool.numbers.size()), pool.values.take());
  }

 private:
  struct Pool {
    std::unordered_map<const void*, std::uint32_t> numbers;  // never iterated
    ByteSink values;
  };
  std::uint32_t version_;
  std::map<std::string, Pool> pools_;
};

template <typename T>
void ByteSink::shared(const std::shared_ptr<const T>& value) {
  VSG_INVARIANT(pools_ != nullptr);
  const std::uint32_t number = pools_->number_of(value);
  bytes(&number, sizeof number);
}

}  // namespace vsgraphs
