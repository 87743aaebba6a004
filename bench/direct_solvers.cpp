// SPDX-License-Identifier: MIT
#include "direct_solvers.h"

#include <omp.h>

#include <algorithm>
#include <stdexcept>

#if DRUMHEAD_BENCH_MUMPS
#include <dmumps_c.h>
#endif
#if DRUMHEAD_BENCH_UMFPACK
#include <umfpack.h>
#endif
#if DRUMHEAD_BENCH_MKL
#include <mkl.h>
#endif

// OpenBLAS's own switch, where the BLAS is OpenBLAS.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace drumhead::bench {
namespace {

using Eigen::VectorXd;

[[maybe_unused]] void require(bool holds, const char* solver, long code) {
  if (!holds) throw std::runtime_error(std::string(solver) + " fails with " + std::to_string(code));
}

/// Values of the lower triangle, column by column.
[[maybe_unused]] std::vector<double> lower(const DirectSolver::Pattern& pattern,
                                           const double* values) {
  std::vector<double> a;
  for (std::size_t j = 0; j + 1 < pattern.columns.size(); ++j)
    for (auto k = pattern.columns[j]; k < pattern.columns[j + 1]; ++k)
      if (pattern.rows[std::size_t(k)] >= std::ptrdiff_t(j)) a.push_back(values[k]);
  return a;
}

#if DRUMHEAD_BENCH_MUMPS
/// LDLᵀ; the lower triangle is handed over.
class Mumps : public DirectSolver {
 public:
  Mumps() {
    data_.par = 1;
    data_.sym = 2;
    data_.comm_fortran = kWorld;
    job(kBegin);
    for (int k = 0; k < 4; ++k) data_.icntl[k] = 0;  // silent
    data_.icntl[13] = 60;                            // % of workspace above the estimate
  }
  ~Mumps() override { job(kEnd); }
  const char* name() const override { return "MUMPS"; }

 protected:
  void analyse(const Pattern& pattern, const double* values) override {
    i_.clear();
    j_.clear();
    for (std::size_t j = 0; j + 1 < pattern.columns.size(); ++j)
      for (auto k = pattern.columns[j]; k < pattern.columns[j + 1]; ++k)
        if (pattern.rows[std::size_t(k)] >= std::ptrdiff_t(j)) {
          i_.push_back(MUMPS_INT(pattern.rows[std::size_t(k)] + 1));
          j_.push_back(MUMPS_INT(j + 1));
        }
    data_.n = MUMPS_INT(pattern.columns.size() - 1);
    data_.nnz = MUMPS_INT8(i_.size());
    data_.irn = i_.data();
    data_.jcn = j_.data();
    std::vector<double> a = lower(pattern, values);
    data_.a = a.data();
    job(kAnalyse);
  }
  VectorXd factorise_and_solve(const Pattern& pattern, const double* values,
                               const VectorXd& right) override {
    std::vector<double> a = lower(pattern, values);
    VectorXd x = right;
    data_.a = a.data();
    data_.rhs = x.data();
    job(kFactoriseAndSolve);
    used(1e6 * data_.infog[21]);
    return x;
  }

 private:
  static constexpr int kWorld = -987654, kBegin = -1, kEnd = -2, kAnalyse = 1,
                       kFactoriseAndSolve = 5;
  void job(int which) {
    data_.job = which;
    dmumps_c(&data_);
    if (which != kEnd) require(data_.infog[0] >= 0, name(), data_.infog[0]);
  }
  DMUMPS_STRUC_C data_{};
  std::vector<MUMPS_INT> i_, j_;
};
#endif

#if DRUMHEAD_BENCH_UMFPACK
/// LU: it does not use the symmetry.
class Umfpack : public DirectSolver {
 public:
  ~Umfpack() override { umfpack_dl_free_symbolic(&symbolic_); }
  const char* name() const override { return "UMFPACK"; }

 protected:
  void analyse(const Pattern& pattern, const double* values) override {
    umfpack_dl_free_symbolic(&symbolic_);
    columns_.assign(pattern.columns.begin(), pattern.columns.end());
    rows_.assign(pattern.rows.begin(), pattern.rows.end());
    const auto n = SuiteSparse_long(columns_.size() - 1);
    double info[UMFPACK_INFO];
    const auto status =
        umfpack_dl_symbolic(n, n, columns_.data(), rows_.data(), values, &symbolic_, nullptr, info);
    require(status >= 0, name(), status);
  }
  VectorXd factorise_and_solve(const Pattern&, const double* values,
                               const VectorXd& right) override {
    double info[UMFPACK_INFO];
    void* numeric = nullptr;
    const auto status = umfpack_dl_numeric(columns_.data(), rows_.data(), values, symbolic_,
                                           &numeric, nullptr, info);
    used(info[UMFPACK_PEAK_MEMORY] * info[UMFPACK_SIZE_OF_UNIT]);
    require(status >= 0, name(), status);
    VectorXd x(right.size());
    umfpack_dl_solve(UMFPACK_A, columns_.data(), rows_.data(), values, x.data(), right.data(),
                     numeric, nullptr, info);
    umfpack_dl_free_numeric(&numeric);
    return x;
  }

 private:
  std::vector<SuiteSparse_long> columns_, rows_;
  void* symbolic_ = nullptr;
};
#endif

#if DRUMHEAD_BENCH_MKL
/// The paper's rival: LDLᵀ with Bunch and Kaufman's pivots.
class Pardiso : public DirectSolver {
 public:
  Pardiso() {
    control_[0] = 1;   // the settings are given here:
    control_[1] = 3;   // nested dissection on several threads
    control_[9] = 8;   // tiny pivots are raised by 1e-8, as its manual has it for such matrices,
    control_[10] = 1;  // after scaling
    control_[12] = 1;  // and matching
    control_[34] = 1;  // counting from 0
  }
  ~Pardiso() override { phase(-1, nullptr, nullptr, nullptr); }
  const char* name() const override { return "MKL PARDISO"; }

 protected:
  void analyse(const Pattern& pattern, const double* values) override {
    if (!rows_.empty()) phase(-1, nullptr, nullptr, nullptr);
    // Columns of the lower triangle are rows of the upper one.
    rows_.assign(1, 0);
    columns_.clear();
    for (std::size_t j = 0; j + 1 < pattern.columns.size(); ++j) {
      for (auto k = pattern.columns[j]; k < pattern.columns[j + 1]; ++k)
        if (pattern.rows[std::size_t(k)] >= std::ptrdiff_t(j))
          columns_.push_back(pattern.rows[std::size_t(k)]);
      rows_.push_back(std::ptrdiff_t(columns_.size()));
    }
    phase(11, lower(pattern, values).data(), nullptr, nullptr);
  }
  VectorXd factorise_and_solve(const Pattern& pattern, const double* values,
                               const VectorXd& right) override {
    const std::vector<double> a = lower(pattern, values);
    VectorXd b = right, x(right.size());
    phase(23, a.data(), b.data(), x.data());
    used(1024.0 * double(std::max(control_[14], control_[15] + control_[16])));
    return x;
  }

 private:
  void phase(MKL_INT64 which, const double* a, double* b, double* x) {
    const MKL_INT64 one = 1, type = -2, n = std::ptrdiff_t(rows_.size()) - 1, quiet = 0;
    MKL_INT64 error = 0;
    pardiso_64(handle_, &one, &one, &type, &which, &n, a, rows_.data(), columns_.data(), nullptr,
               &one, control_, &quiet, b, x, &error);
    if (which > 0) require(error == 0, name(), error);
  }
  void* handle_[64] = {};
  MKL_INT64 control_[64] = {};
  std::vector<MKL_INT64> rows_, columns_;
};
#endif

}  // namespace

VectorXd DirectSolver::solve(const Eigen::SparseMatrix<double>& matrix, const VectorXd& right) {
  Pattern pattern{{matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.cols() + 1},
                  {matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros()}};
  if (!(pattern == pattern_)) {
    pattern_ = std::move(pattern);
    analyse(pattern_, matrix.valuePtr());
  }
  return factorise_and_solve(pattern_, matrix.valuePtr(), right);
}

std::vector<std::unique_ptr<DirectSolver>> direct_solvers() {
  std::vector<std::unique_ptr<DirectSolver>> all;
#if DRUMHEAD_BENCH_MKL
  all.push_back(std::make_unique<Pardiso>());
#endif
#if DRUMHEAD_BENCH_MUMPS
  all.push_back(std::make_unique<Mumps>());
#endif
#if DRUMHEAD_BENCH_UMFPACK
  all.push_back(std::make_unique<Umfpack>());
#endif
  return all;
}

void set_blas_threads(int threads) {
  omp_set_num_threads(threads);
  if (openblas_set_num_threads) openblas_set_num_threads(threads);
#if DRUMHEAD_BENCH_MKL
  // The threads that this program has, instead of Intel's own; said before MKL is first used.
  mkl_set_threading_layer(MKL_THREADING_GNU);
  mkl_set_num_threads(threads);
#endif
}

}  // namespace drumhead::bench
