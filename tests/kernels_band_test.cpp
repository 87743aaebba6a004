// SPDX-License-Identifier: MIT
// Spans of the band beside listed cells, against a look at every cell.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include <drumhead/kernels/band.h>

namespace drumhead {
namespace {

struct Lattice {
  int nx, ny;
  std::vector<int> row_begin{0}, column;
  Lattice(int nx_, int ny_, double share, std::mt19937& bits) : nx(nx_), ny(ny_) {
    std::bernoulli_distribution listed(share);
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i)
        if (listed(bits)) column.push_back(i);
      row_begin.push_back(int(column.size()));
    }
  }
  /// Whether a listed cell is that close.
  bool listed(int i, int j, int width) const {
    for (int row = std::max(0, j - width); row < std::min(ny, j + width + 1); ++row)
      for (int k = row_begin[std::size_t(row)]; k < row_begin[std::size_t(row) + 1]; ++k)
        if (std::abs(column[std::size_t(k)] - i) <= width) return true;
    return false;
  }
};

TEST(KernelsBand, HasTheCellsWithinItsWidthAsFewestSpans) {
  std::mt19937 bits(5);
  for (int trial = 0; trial < 400; ++trial) {
    const Lattice lattice(1 + trial % 23, 1 + trial % 7, trial % 5 * .04, bits);
    for (const int width : {0, 1, 2, 3})
      for (const bool without : {false, true}) {
        const kernels::Band band(lattice.row_begin, lattice.column, lattice.nx, width, without);
        for (int j = 0; j < lattice.ny; ++j) {
          int last = -1;
          std::vector<bool> inside(std::size_t(lattice.nx), false);
          for (const kernels::Span span : band.row(j)) {
            ASSERT_GT(span.begin, last);
            ASSERT_GT(span.end, span.begin);
            ASSERT_LE(span.end, lattice.nx);
            last = span.end;
            for (int i = span.begin; i < span.end; ++i) inside[std::size_t(i)] = true;
          }
          for (int i = 0; i < lattice.nx; ++i)
            EXPECT_EQ(inside[std::size_t(i)],
                      lattice.listed(i, j, width) && !(without && lattice.listed(i, j, 0)));
        }
      }
  }
}

}  // namespace
}  // namespace drumhead
