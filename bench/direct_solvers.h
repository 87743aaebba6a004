// SPDX-License-Identifier: MIT
#pragma once
// Sparse direct solvers of other people behind one interface, to solve the assembled Newton
// systems. An analysis is kept as long as the matrix keeps its pattern.
#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/SparseCore>

namespace drumhead::bench {

class DirectSolver {
 public:
  /// Both triangles, column by column, 0-based; their values are the matrix's own.
  struct Pattern {
    std::vector<std::ptrdiff_t> columns, rows;
    bool operator==(const Pattern&) const = default;
  };

  virtual ~DirectSolver() = default;
  virtual const char* name() const = 0;
  /// Solves matrix · x = right, the matrix symmetric and indefinite. Throws std::runtime_error
  /// where the solver fails.
  Eigen::VectorXd solve(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& right);
  /// Greatest memory of a factorisation, as the solver counts it.
  double peak_bytes() const { return peak_bytes_; }

 protected:
  virtual void analyse(const Pattern& pattern, const double* values) = 0;
  virtual Eigen::VectorXd factorise_and_solve(const Pattern& pattern, const double* values,
                                              const Eigen::VectorXd& right) = 0;
  void used(double bytes) { peak_bytes_ = std::max(peak_bytes_, bytes); }

 private:
  Pattern pattern_;
  double peak_bytes_ = 0.0;
};

/// All that this program was built with: MUMPS, UMFPACK, MKL PARDISO.
std::vector<std::unique_ptr<DirectSolver>> direct_solvers();

/// Threads of the solvers' own dense kernels.
void set_blas_threads(int threads);

}  // namespace drumhead::bench
