// The reverse of field_writer.h: fills a value from bytes that may be damaged. Whatever they hold, the result is a value
// or InputError: lengths are checked against the bytes that are left before anything is allocated.
#pragma once

#include <algorithm>
#include <cstring>
#include <functional>
#include <span>

#include "core/base/shared_pool.h"

namespace vsgraphs {

// Shared constants by type, each a list of std::shared_ptr<const T> of the type named.
class SharedConstants {
 public:
  template <typename T>
  void set(std::vector<std::shared_ptr<const T>> values) {
    lists_[shared_name<T>].assign(values.begin(), values.end());
  }
  template <typename T>
  bool known() const {
    return lists_.contains(shared_name<T>);
  }
  // nullptr if there are not so many.
  template <typename T>
  std::shared_ptr<const T> get(std::uint32_t number) const {
    const auto list = lists_.find(shared_name<T>);
    if (list == lists_.end() || number >= list->second.size()) return nullptr;
    return std::static_pointer_cast<const T>(list->second[number]);
  }

 private:
  std::map<std::string, std::vector<std::shared_ptr<const void>>> lists_;
};

class FieldReader {
 public:
  static constexpr bool reads = true;
  // `fail` is given what is wrong and must throw. `shared` may be null where no shared constants are read.
  // `version`: of the format they are in.
  FieldReader(std::span<const std::byte> bytes, const SharedConstants* shared,
              std::function<void(const std::string&)> fail, std::uint32_t version = UINT32_MAX)
      : bytes_(bytes), shared_(shared), fail_(std::move(fail)), version_(version) {}

  template <typename... T>
  void operator()(T&... values) {
    (read(values), ...);
  }
  template <typename... T>
  void since(std::uint32_t version, T&... values) {
    if (version_ >= version) (read(values), ...);
  }
  void require(bool ok, const char* what) const {
    if (!ok) failed(what);
  }
  std::size_t left() const { return bytes_.size(); }
  // How many items follow, each of at least `least` bytes.
  std::size_t count(std::size_t least) {
    std::uint64_t n = 0;
    read(n);
    require(n <= left() / std::max<std::size_t>(1, least), "a length exceeds what is there");
    return static_cast<std::size_t>(n);
  }

 private:
  [[noreturn]] void failed(const char* what) const {
    fail_(what);
    throw InvariantError("FieldReader: its fail function returned");
  }
  void raw(void* to, std::size_t n) {
    if (n > bytes_.size()) failed("it ends too early");
    std::memcpy(to, bytes_.data(), n);
    bytes_ = bytes_.subspan(n);
  }

  template <typename T>
  void read(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;
      raw(&byte, 1);
      require(byte <= 1, "neither yes nor no");
      value = byte != 0;
    } else if constexpr (std::is_arithmetic_v<T>) {
      raw(&value, sizeof value);
    } else if constexpr (std::is_enum_v<T>) {
      std::underlying_type_t<T> number{};
      read(number);
      require(static_cast<std::uint64_t>(number) < enum_size<T>, "a kind that does not exist");
      value = static_cast<T>(number);
    } else if constexpr (FixedMatrix<T>) {
      raw(value.data(), sizeof(typename T::Scalar) * static_cast<std::size_t>(T::SizeAtCompileTime));
    } else if constexpr (is_sequence<T>) {
      read_sequence(value);
    } else {
      visit_fields(value, *this);
    }
  }
  template <typename Sequence>
  void read_sequence(Sequence& values) {
    const std::size_t n = count(least_bytes<typename Sequence::value_type>());
    values.clear();
    values.resize(n);
    for (auto& value : values) read(value);
  }
  template <typename T, std::size_t n>
  void read(std::array<T, n>& values) {
    for (T& value : values) read(value);
  }
  template <typename T>
  void read(std::optional<T>& value) {
    bool there = false;
    read(there);
    value.reset();
    if (there) read(value.emplace());
  }
  template <typename Key, typename T>
  void read(std::map<Key, T>& values) {
    const std::size_t n = count(least_bytes<Key>() + least_bytes<T>());
    values.clear();
    for (std::size_t i = 0; i < n; ++i) {
      Key key{};
      read(key);
      require(values.empty() || values.rbegin()->first < key, "keys out of order");
      read(values.emplace_hint(values.end(), key, T{})->second);
    }
  }
  template <typename T>
  void read(std::shared_ptr<const T>& value) {
    std::uint32_t number = 0;
    read(number);
    value = shared_ && number != SharedPools::none ? shared_->get<T>(number) : nullptr;
    require(value || number == SharedPools::none, "a shared value that does not exist");
  }

  std::span<const std::byte> bytes_;
  const SharedConstants* shared_;
  std::function<void(const std::string&)> fail_;
  std::uint32_t version_;
};

}  // namespace vsgraphs
