// SPDX-License-Identifier: MIT
#pragma once
// Sparse systems whose unknowns come in blocks in a row, each of which is coupled to the one before
// it and the one after it alone, as those beside a curve are: a block LU factorisation with row
// pivots within the blocks, for definite and indefinite matrices. Cost: linear in the number of
// blocks, cubic in their size.
#include <cstddef>
#include <memory>
#include <vector>

#include "envelope.h"

namespace drumhead::multigrid {

class Chain {
 public:
  Chain();
  ~Chain();
  Chain(Chain&&) noexcept;

  /// Factorises A, every row of which must be given. Block n has the rows block_begin[n] …
  /// block_begin[n + 1] − 1.
  void factorise(const SparseRows& a, const std::vector<int>& block_begin);
  /// x := A⁻¹ x.
  void solve(std::vector<double>& x);
  std::size_t bytes() const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace drumhead::multigrid
