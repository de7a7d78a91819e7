#include "core/solve/bundle/block_matrix.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "core/base/check.h"

namespace vsgraphs {

void BlockMatrix::build(const std::vector<int>& dims, const std::vector<std::vector<int>>& rows) {
  dims_ = dims;
  offsets_.assign(1, 0);
  for (int dim : dims_) offsets_.push_back(offsets_.back() + dim);
  column_begin_.assign(1, 0);
  value_begin_.assign(1, 0);
  row_of_.clear();
  for (int c = 0; c < variables(); ++c) {
    VSG_INVARIANT(!rows[c].empty() && rows[c].front() == c);
    for (int r : rows[c]) {
      row_of_.push_back(r);
      value_begin_.push_back(value_begin_.back() + dims_[r] * dims_[c]);
    }
    column_begin_.push_back(static_cast<int>(row_of_.size()));
  }
}

int BlockMatrix::find(int row, int column) const {
  const auto first = row_of_.begin() + column_begin_[column],
             last = row_of_.begin() + column_begin_[column + 1];
  const auto at = std::lower_bound(first, last, row);
  VSG_INVARIANT(at != last && *at == row);
  return static_cast<int>(at - row_of_.begin());
}

void BlockMatrix::to_dense(const double* values, Eigen::MatrixXd& out) const {
  out.setZero(scalars(), scalars());
  for (int c = 0; c < variables(); ++c) {
    for (int b = column_begin_[c]; b < column_begin_[c + 1]; ++b) {
      const int r = row_of_[b];
      out.block(offsets_[r], offsets_[c], dims_[r], dims_[c]) =
          Eigen::Map<const Eigen::MatrixXd>(values + value_begin_[b], dims_[r], dims_[c]);
    }
  }
}

void BlockMatrix::to_sparse(const double* values, Eigen::SparseMatrix<double>& out) const {
  if (out.nonZeros() == 0) {
    out.resize(scalars(), scalars());
    out.resizeNonZeros(static_cast<Eigen::Index>(value_count()));
    int filled = 0;
    for (int c = 0; c < variables(); ++c) {
      for (int k = 0; k < dims_[c]; ++k) {
        out.outerIndexPtr()[offsets_[c] + k] = filled;
        for (int b = column_begin_[c]; b < column_begin_[c + 1]; ++b) {
          for (int i = 0; i < dims_[row_of_[b]]; ++i)
            out.innerIndexPtr()[filled++] = offsets_[row_of_[b]] + i;
        }
      }
    }
    out.outerIndexPtr()[scalars()] = filled;
  }
  double* to = out.valuePtr();
  for (int c = 0; c < variables(); ++c) {
    for (int k = 0; k < dims_[c]; ++k) {
      for (int b = column_begin_[c]; b < column_begin_[c + 1]; ++b) {
        const int height = dims_[row_of_[b]];
        to = std::copy_n(values + value_begin_[b] + k * height, height, to);
      }
    }
  }
}

bool ReducedSolver::solve(const double* values, const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  if (b.size() == 0) {
    x.resize(0);
    return true;
  }
  if (sparse_) {
    pattern_.to_sparse(values, sparse_matrix_);
    if (!analyzed_) sparse_cholesky_.analyzePattern(sparse_matrix_);
    analyzed_ = true;
    sparse_cholesky_.factorize(sparse_matrix_);
    if (sparse_cholesky_.info() != Eigen::Success || !(sparse_cholesky_.vectorD().minCoeff() > 0))
      return false;
    x = sparse_cholesky_.solve(b);
    return x.allFinite();
  }
  pattern_.to_dense(values, dense_matrix_);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(dense_matrix_);  // in place
  if (cholesky.info() != Eigen::Success) return false;
  x = cholesky.solve(b);
  return x.allFinite();
}

}  // namespace vsgraphs
