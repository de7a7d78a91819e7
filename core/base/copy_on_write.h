// A value that copies share until one of them changes it, so that a copy costs a pointer.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

#include "core/base/fields.h"

namespace vsgraphs {

// Whoever was copied from, or is a copy, makes the value its own before changing it: as the map's tables do, without reading
// reference counts. Copying something that was itself copied before, and not changed since, writes nothing to it: several threads may.
template <typename T>
class CopyOnWrite {
 public:
  CopyOnWrite() : CopyOnWrite(T{}) {}
  explicit CopyOnWrite(T value) : value_(std::make_shared<T>(std::move(value))) {}
  CopyOnWrite(const CopyOnWrite& other) : value_(other.value_), own_(false) {
    if (other.own_) other.own_ = false;
  }
  CopyOnWrite& operator=(const CopyOnWrite& other) {
    CopyOnWrite copy(other);
    std::swap(value_, copy.value_);
    std::swap(own_, copy.own_);
    return *this;
  }
  CopyOnWrite(CopyOnWrite&&) noexcept = default;
  CopyOnWrite& operator=(CopyOnWrite&&) noexcept = default;
  ~CopyOnWrite() = default;

  const T& operator*() const { return *value_; }
  const T* operator->() const { return value_.get(); }
  T& edit() {
    if (!own_) value_ = std::make_shared<T>(*value_);
    own_ = true;
    return *value_;
  }

  template <FieldsOf<CopyOnWrite> V>
  friend void visit_fields(V& v, auto& field) {
    if constexpr (std::remove_reference_t<decltype(field)>::reads)
      field(v.edit());
    else
      field(*v);
  }

 private:
  std::shared_ptr<T> value_;
  mutable bool own_ = true;
};

}  // namespace vsgraphs
