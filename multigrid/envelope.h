// SPDX-License-Identifier: MIT
#pragma once
// Symmetric positive definite systems of long thin graphs, as the rows along curves have them:
// reverse Cuthill–McKee ordering, then a Cholesky factorisation A = L D Lᵀ within the envelope.
// Cost: linear in the length of the graph, quadratic in its width.
#include <cstddef>
#include <vector>

namespace drumhead::multigrid {

/// A sparse matrix by rows; entries of a row in any order, doubles added up.
struct SparseRows {
  std::vector<int> begin = {0}, column;
  std::vector<double> value;
  int rows() const { return int(begin.size()) - 1; }
  void add(int at, double entry) {
    column.push_back(at);
    value.push_back(entry);
  }
  void end_row() { begin.push_back(int(column.size())); }
  std::size_t bytes() const {
    return (begin.size() + column.size()) * sizeof(int) + value.size() * sizeof(double);
  }
};

class Envelope {
 public:
  /// Factorises A + s I, s = `shift` times the largest diagonal entry of A, of which every entry
  /// and its mirror image must be given. No pivot is below s: rows may depend on one another.
  void factorise(const SparseRows& a, double shift);
  /// x := A⁻¹ x.
  void solve(std::vector<double>& x);
  std::size_t bytes() const;

 private:
  void order(const SparseRows& a);
  void fill(const SparseRows& a);
  double* row(int k) { return value_.data() + start_[std::size_t(k)] - first_[std::size_t(k)]; }

  std::vector<int> position_;  ///< of each unknown in the order
  std::vector<int> first_;     ///< first column of the row's envelope
  std::vector<std::ptrdiff_t>
      start_;  ///< where that is in value_; the row ends before its diagonal
  std::vector<double> value_, diagonal_, ordered_;
};

}  // namespace drumhead::multigrid
