// Goes through a value field by field (fields.h) and hands its bytes to a sink: little-endian numbers as they lie in
// memory, lengths before what they count.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/fields.h"

namespace vsgraphs {

static_assert(std::endian::native == std::endian::little, "archives are little-endian, without conversion");

// A matrix of fixed size (Eigen's, which this layer does not know).
template <typename T>
concept FixedMatrix = requires(T m) {
  m.data();
  m.coeff(0);
  requires T::SizeAtCompileTime > 0;
};

template <typename T>
inline constexpr bool is_sequence = false;
template <typename T>
inline constexpr bool is_sequence<std::vector<T>> = true;
template <typename T>
inline constexpr bool is_sequence<std::deque<T>> = true;
template <>
inline constexpr bool is_sequence<std::string> = true;

// Sink: bytes(const void*, std::size_t) and shared(const std::shared_ptr<const T>&).
template <typename Sink>
class FieldWriter {
 public:
  static constexpr bool reads = false;
  // `version`: of the format that is written.
  explicit FieldWriter(Sink& sink, std::uint32_t version = UINT32_MAX) : sink_(sink), version_(version) {}

  template <typename... T>
  void operator()(const T&... values) {
    (write(values), ...);
  }
  template <typename... T>
  void since(std::uint32_t version, const T&... values) {
    if (version_ >= version) (write(values), ...);
  }

 private:
  template <typename T>
  void write(const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      sink_.bytes(&value, sizeof value);
    } else if constexpr (std::is_enum_v<T>) {
      static_assert(enum_size<T> > 0, "say beside the enum how many values it has");
      write(static_cast<std::underlying_type_t<T>>(value));
    } else if constexpr (FixedMatrix<T>) {
      sink_.bytes(value.data(), sizeof(typename T::Scalar) * static_cast<std::size_t>(T::SizeAtCompileTime));
    } else if constexpr (is_sequence<T>) {
      write(static_cast<std::uint64_t>(value.size()));
      for (const auto& item : value) write(item);
    } else {
      visit_fields(value, *this);
    }
  }
  template <typename T, std::size_t n>
  void write(const std::array<T, n>& values) {
    for (const T& value : values) write(value);
  }
  template <typename T>
  void write(const std::optional<T>& value) {
    write(value.has_value());
    if (value) write(*value);
  }
  template <typename Key, typename T>
  void write(const std::map<Key, T>& values) {
    write(static_cast<std::uint64_t>(values.size()));
    for (const auto& [key, value] : values) (*this)(key, value);
  }
  template <typename T>
  void write(const std::shared_ptr<const T>& value) {
    sink_.shared(value);
  }

  Sink& sink_;
  std::uint32_t version_;
};

// Counts bytes and keeps none.
class CountingSink {
 public:
  void bytes(const void*, std::size_t count) { count_ += count; }
  template <typename T>
  void shared(const std::shared_ptr<const T>&) {
    count_ += sizeof(std::uint32_t);
  }
  std::size_t count() const { return count_; }

 private:
  std::size_t count_ = 0;
};

// The fewest bytes any value of the type is written in, by any version: those of a fresh one, whose containers are empty.
template <typename T>
std::size_t least_bytes() {
  CountingSink sink;
  FieldWriter<CountingSink> count(sink, 0);
  count(T{});
  return sink.count();
}

}  // namespace vsgraphs
