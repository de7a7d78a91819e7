// A grid of cells that grows as needed: a face of the world seen squarely, cell by cell.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/fields.h"

namespace vsgraphs {

struct Cell {
  int s = 0, t = 0;
  auto operator<=>(const Cell&) const = default;
};

inline Cell cell_at(double s_m, double t_m, double size_m) {
  return {static_cast<int>(std::floor(s_m / size_m)), static_cast<int>(std::floor(t_m / size_m))};
}

// Of grids that are read: some kilometres to each side, so that nothing overflows.
inline constexpr int farthest_cell = 1 << 16;

template <typename Value>
class CellGrid {
 public:
  bool empty() const { return values_.empty(); }
  int min_s() const { return min_.s; }
  int min_t() const { return min_.t; }
  int end_s() const { return min_.s + columns_; }
  int end_t() const { return min_.t + rows_; }
  bool contains(Cell c) const { return c.s >= min_.s && c.t >= min_.t && c.s < end_s() && c.t < end_t(); }
  // A default value outside.
  Value at(Cell c) const { return contains(c) ? values_[place(c)] : Value{}; }
  // Grows to hold the cell.
  Value& operator[](Cell c) {
    if (!contains(c)) grow(c);
    return values_[place(c)];
  }
  std::size_t memory_bytes() const { return values_.size() * sizeof(Value); }

  template <FieldsOf<CellGrid> T>
  friend void visit_fields(T& v, auto& field) {
    field(v.min_.s, v.min_.t, v.columns_, v.rows_, v.values_);
    if constexpr (std::remove_reference_t<decltype(field)>::reads)
      field.require(v.fits_together(), "cells that do not fit together");
  }

 private:
  std::size_t place(Cell c) const {
    return static_cast<std::size_t>(c.t - min_.t) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(c.s - min_.s);
  }
  // By some cells more than needed, so that walking along a wall does not copy it at every step.
  void grow(Cell c) {
    constexpr int margin = 8;
    CellGrid bigger;
    if (empty()) {
      bigger.min_ = {c.s - margin, c.t - margin};
      bigger.columns_ = bigger.rows_ = 2 * margin + 1;
    } else {
      bigger.min_ = {c.s < min_.s ? c.s - margin : min_.s, c.t < min_.t ? c.t - margin : min_.t};
      bigger.columns_ = (c.s >= end_s() ? c.s + margin : end_s() - 1) - bigger.min_.s + 1;
      bigger.rows_ = (c.t >= end_t() ? c.t + margin : end_t() - 1) - bigger.min_.t + 1;
    }
    bigger.values_.resize(static_cast<std::size_t>(bigger.columns_) * static_cast<std::size_t>(bigger.rows_));
    for (int t = min_.t; t < end_t(); ++t) {
      for (int s = min_.s; s < end_s(); ++s) bigger.values_[bigger.place({s, t})] = values_[place({s, t})];
    }
    *this = std::move(bigger);
  }

  bool fits_together() const {
    const auto near = [](int cell) { return cell >= -farthest_cell && cell <= farthest_cell; };
    return near(min_.s) && near(min_.t) && columns_ >= 0 && rows_ >= 0 && columns_ <= 2 * farthest_cell &&
           rows_ <= 2 * farthest_cell &&
           values_.size() == static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  }

  Cell min_;
  int columns_ = 0, rows_ = 0;
  std::vector<Value> values_;
};

}  // namespace vsgraphs
