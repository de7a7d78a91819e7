// Symmetric block matrix of the reduced system: lower half, only blocks that exist, each contiguous and column-major.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <vector>

namespace vsgraphs {

class BlockMatrix {
 public:
  // dims[i]: scalars of variable i. rows[c]: the ascending variables r >= c with a block (r, c); rows[c][0] == c.
  void build(const std::vector<int>& dims, const std::vector<std::vector<int>>& rows);

  int variables() const { return static_cast<int>(dims_.size()); }
  int scalars() const { return offsets_.back(); }
  int offset(int variable) const { return offsets_[variable]; }
  int dim(int variable) const { return dims_[variable]; }
  int diagonal(int variable) const { return column_begin_[variable]; }
  // Block id of (row, column), row >= column; it must exist.
  int find(int row, int column) const;
  int value_begin(int block) const { return value_begin_[block]; }
  std::size_t value_count() const { return static_cast<std::size_t>(value_begin_.back()); }

  // Lower half of a dense matrix from the block values.
  void to_dense(const double* values, Eigen::MatrixXd& out) const;
  // Compressed columns of the lower block half (diagonal blocks in full); the pattern is the same every time.
  void to_sparse(const double* values, Eigen::SparseMatrix<double>& out) const;

 private:
  std::vector<int> dims_, offsets_;         // offsets_: one past the end too
  std::vector<int> column_begin_, row_of_;  // compressed block columns
  std::vector<int> value_begin_;            // one past the end too
};

// Cholesky of the damped reduced system: dense for windows, sparse (Eigen SimplicialLDLT, AMD ordering) for maps.
class ReducedSolver {
 public:
  ReducedSolver(const BlockMatrix& pattern, bool sparse) : pattern_(pattern), sparse_(sparse) {}
  // Solves values * x = b; false when the matrix is not positive definite or the result not finite.
  bool solve(const double* values, const Eigen::VectorXd& b, Eigen::VectorXd& x);

 private:
  const BlockMatrix& pattern_;
  bool sparse_;
  bool analyzed_ = false;
  Eigen::MatrixXd dense_matrix_;
  Eigen::SparseMatrix<double> sparse_matrix_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> sparse_cholesky_;
};

}  // namespace vsgraphs
