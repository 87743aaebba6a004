// SPDX-License-Identifier: MIT
#include "chain.h"

#include <Eigen/LU>

namespace drumhead::multigrid {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Chain::Factors {
  std::vector<int> begin;
  SparseRows before, after;  ///< entries of each row in the block before its own and after it
  std::vector<Eigen::PartialPivLU<MatrixXd>> pivot;
  VectorXd held;

  Index first(std::size_t n) const { return begin[n]; }
  Index size(std::size_t n) const { return begin[n + 1] - begin[n]; }
  /// Entries of A in block n's own columns; the others are filed in `before` and `after`.
  MatrixXd take_block(const SparseRows& a, std::size_t n);
};

Chain::Chain() : factors_(std::make_unique<Factors>()) {}
Chain::~Chain() = default;
Chain::Chain(Chain&&) noexcept = default;

MatrixXd Chain::Factors::take_block(const SparseRows& a, std::size_t n) {
  MatrixXd own = MatrixXd::Zero(size(n), size(n));
  for (int row = begin[n]; row < begin[n + 1]; ++row) {
    for (int e = a.begin[std::size_t(row)]; e < a.begin[std::size_t(row) + 1]; ++e) {
      const int column = a.column[std::size_t(e)];
      const double value = a.value[std::size_t(e)];
      if (column < begin[n])
        before.add(column, value);
      else if (column >= begin[n + 1])
        after.add(column, value);
      else
        own(row - begin[n], column - begin[n]) += value;
    }
    before.end_row();
    after.end_row();
  }
  return own;
}

void Chain::factorise(const SparseRows& a, const std::vector<int>& block_begin) {
  Factors& f = *factors_;
  f.begin = block_begin;
  f.before = f.after = {};
  f.pivot.clear();
  for (std::size_t n = 0; n + 1 < f.begin.size(); ++n) {
    MatrixXd own = f.take_block(a, n);
    if (n > 0) {
      // A_n,n − A_n,n−1 P⁻¹ A_n−1,n with the pivot P of the block before.
      MatrixXd image = MatrixXd::Zero(f.size(n - 1), f.size(n));
      for (Index row = 0; row < image.rows(); ++row) {
        const std::size_t at = std::size_t(f.first(n - 1) + row);
        for (int e = f.after.begin[at]; e < f.after.begin[at + 1]; ++e)
          image(row, f.after.column[std::size_t(e)] - f.first(n)) += f.after.value[std::size_t(e)];
      }
      image = f.pivot.back().solve(image);
      for (Index row = 0; row < own.rows(); ++row) {
        const std::size_t at = std::size_t(f.first(n) + row);
        for (int e = f.before.begin[at]; e < f.before.begin[at + 1]; ++e)
          own.row(row) -= f.before.value[std::size_t(e)] *
                          image.row(f.before.column[std::size_t(e)] - f.first(n - 1));
      }
    }
    f.pivot.emplace_back(own);
  }
}

void Chain::solve(std::vector<double>& x) {
  Factors& f = *factors_;
  const std::size_t blocks = f.pivot.size();
  Eigen::Map<VectorXd> y(x.data(), Index(x.size()));
  auto subtract = [&](const SparseRows& part, std::size_t n, auto&& out) {
    for (Index row = 0; row < f.size(n); ++row) {
      const std::size_t at = std::size_t(f.first(n) + row);
      for (int e = part.begin[at]; e < part.begin[at + 1]; ++e)
        out[row] -= part.value[std::size_t(e)] * x[std::size_t(part.column[std::size_t(e)])];
    }
  };
  for (std::size_t n = 0; n < blocks; ++n) {
    auto own = y.segment(f.first(n), f.size(n));
    if (n > 0) subtract(f.before, n, own);
    f.held = f.pivot[n].solve(own);
    own = f.held;
  }
  for (std::size_t n = blocks; n-- > 1;) {
    f.held = VectorXd::Zero(f.size(n - 1));
    subtract(f.after, n - 1, f.held);
    y.segment(f.first(n - 1), f.size(n - 1)) += f.pivot[n - 1].solve(f.held);
  }
}

std::size_t Chain::bytes() const {
  const Factors& f = *factors_;
  std::size_t values = 0;
  for (std::size_t n = 0; n < f.pivot.size(); ++n)
    values += std::size_t(f.size(n)) * std::size_t(f.size(n) + 1);
  return f.begin.size() * sizeof(int) + f.before.bytes() + f.after.bytes() +
         values * sizeof(double);
}

}  // namespace drumhead::multigrid
