// SPDX-License-Identifier: MIT
#include "envelope.h"

#include <algorithm>
#include <numeric>

namespace drumhead::multigrid {

/// Breadth first through each component, from an end of it: the last unknown of a first pass.
void Envelope::order(const SparseRows& a) {
  const std::size_t n = std::size_t(a.rows());
  std::vector<int> sequence, level(n, -1), queue;
  auto degree = [&](int k) { return a.begin[std::size_t(k) + 1] - a.begin[std::size_t(k)]; };
  auto visit = [&](int from, int mark) {
    queue.assign(1, from);
    level[std::size_t(from)] = mark;
    for (std::size_t at = 0; at < queue.size(); ++at) {
      const std::size_t k = std::size_t(queue[at]), old = queue.size();
      for (int e = a.begin[k]; e < a.begin[k + 1]; ++e) {
        int& seen = level[std::size_t(a.column[std::size_t(e)])];
        if (seen == mark) continue;
        seen = mark;
        queue.push_back(a.column[std::size_t(e)]);
      }
      std::sort(queue.begin() + std::ptrdiff_t(old), queue.end(), [&](int p, int q) {
        return degree(p) != degree(q) ? degree(p) < degree(q) : p < q;
      });
    }
  };
  for (std::size_t k = 0; k < n; ++k) {
    if (level[k] >= 0) continue;
    visit(int(k), 0);
    visit(queue.back(), 1);
    sequence.insert(sequence.end(), queue.begin(), queue.end());
  }
  std::ranges::reverse(sequence);
  position_.resize(n);
  for (std::size_t k = 0; k < n; ++k) position_[std::size_t(sequence[k])] = int(k);
}

void Envelope::fill(const SparseRows& a) {
  const std::size_t n = std::size_t(a.rows());
  first_.resize(n);
  std::iota(first_.begin(), first_.end(), 0);
  for (std::size_t k = 0; k < n; ++k)
    for (int e = a.begin[k]; e < a.begin[k + 1]; ++e) {
      int& first = first_[std::size_t(position_[k])];
      first = std::min(first, position_[std::size_t(a.column[std::size_t(e)])]);
    }
  start_.assign(1, 0);
  for (std::size_t k = 0; k < n; ++k) start_.push_back(start_[k] + (int(k) - first_[k]));
  value_.assign(std::size_t(start_[n]), 0.0);
  diagonal_.assign(n, 0.0);
  for (std::size_t k = 0; k < n; ++k)
    for (int e = a.begin[k]; e < a.begin[k + 1]; ++e) {
      const int i = position_[k], j = position_[std::size_t(a.column[std::size_t(e)])];
      if (i == j) diagonal_[std::size_t(i)] += a.value[std::size_t(e)];
      if (j < i) row(i)[j] += a.value[std::size_t(e)];
    }
}

void Envelope::factorise(const SparseRows& a, double shift) {
  order(a);
  fill(a);
  const int n = a.rows();
  ordered_.resize(std::size_t(n));
  const double floor = n > 0 ? shift * *std::ranges::max_element(diagonal_) : 0.0;
  for (int i = 0; i < n; ++i) {
    double* const l = row(i);
    const int first = first_[std::size_t(i)];
    // (L D)_ij from the rows above, then L_ij and the pivot.
    for (int j = first; j < i; ++j) {
      const double* const above = row(j);
      double sum = l[j];
      for (int k = std::max(first, first_[std::size_t(j)]); k < j; ++k) sum -= l[k] * above[k];
      l[j] = sum;
    }
    double pivot = diagonal_[std::size_t(i)] + floor;
    for (int j = first; j < i; ++j) {
      const double entry = l[j] / diagonal_[std::size_t(j)];
      pivot -= entry * l[j];
      l[j] = entry;
    }
    diagonal_[std::size_t(i)] = std::max(pivot, floor);
  }
}

void Envelope::solve(std::vector<double>& x) {
  const int n = int(position_.size());
  double* const y = ordered_.data();
  for (int k = 0; k < n; ++k) y[position_[std::size_t(k)]] = x[std::size_t(k)];
  for (int i = 0; i < n; ++i) {
    const double* const l = row(i);
    double sum = y[i];
    for (int j = first_[std::size_t(i)]; j < i; ++j) sum -= l[j] * y[j];
    y[i] = sum;
  }
  for (int i = 0; i < n; ++i) y[i] /= diagonal_[std::size_t(i)];
  for (int i = n - 1; i >= 0; --i) {
    const double* const l = row(i);
    for (int j = first_[std::size_t(i)]; j < i; ++j) y[j] -= l[j] * y[i];
  }
  for (int k = 0; k < n; ++k) x[std::size_t(k)] = y[position_[std::size_t(k)]];
}

std::size_t Envelope::bytes() const {
  return (position_.size() + first_.size()) * sizeof(int) + start_.size() * sizeof(start_[0]) +
         (value_.size() + diagonal_.size() + ordered_.size()) * sizeof(double);
}

}  // namespace drumhead::multigrid
