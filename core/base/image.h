// Views of pixels owned by somebody else, and a small owning image. Row-major; `stride` in elements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/fields.h"

namespace vsgraphs {

template <typename T>
struct ImageView {
  const T* data = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;  // elements from one row to the next

  bool empty() const { return data == nullptr || width <= 0 || height <= 0; }
  const T* row(int v) const { return data + v * stride; }
  const T& at(int u, int v) const { return row(v)[u]; }
};

template <typename T>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<T> pixels;

  Image() = default;
  Image(int w, int h, T value = T{}) : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, value) {}

  bool empty() const { return pixels.empty(); }
  T& at(int u, int v) { return pixels[static_cast<std::size_t>(v) * width + u]; }
  const T& at(int u, int v) const { return pixels[static_cast<std::size_t>(v) * width + u]; }
  ImageView<T> view() const { return {pixels.data(), width, height, width}; }
};

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};
template <FieldsOf<Rgb> T>
void visit_fields(T& v, auto& field) {
  auto& [r, g, b] = v;
  field(r, g, b);
}

}  // namespace vsgraphs
