// SPDX-License-Identifier: MIT
#include "competitors.h"

#include <drumhead/kernels/elastic.h>

#include "native.h"
#include "support/kernel_oracle.h"
#if DRUMHEAD_BENCH_PETSC
#include <petscmat.h>
#endif

namespace drumhead::bench {

using Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

struct Problem {
  explicit Problem(int n)
      : level({.nx = n, .ny = n, .layout = fields::Layout::exact}), out(n, n, true) {}
  fields::RandomLevel<float> level;
  fields::OwnedUnknowns<float> out;
};

class Product {
 public:
  virtual ~Product() = default;
  virtual std::string name() const = 0;
  virtual void run() = 0;
  /// Largest difference from our result relative to the largest value.
  virtual double error(const Problem& problem) const = 0;
};

namespace {

class PlainLoop : public Product {
 public:
  explicit PlainLoop(const Problem& problem) {
    const fields::RandomLevel<float>& level = problem.level;
    in_ = {level.ux.values(),  level.uy.values(),  level.pressure.values(),
           level.d.x.values(), level.d.y.values(), level.d.p.values()};
    out_.resize(problem.out.values().size());
    op_ = {.n = level.spec.nx,
           .mu = level.mu_value,
           .spacing = float(level.spec.spacing),
           .compliance = level.compliance_value,
           .clamp_centre = level.clamp_centre,
           .clamp_width = level.clamp_width};
  }
  std::string name() const override { return "plain loop, -O3 -march=native"; }
  void run() override {
    float *x = out_.data(), *y = x + in_[0].size(), *p = y + in_[1].size();
    plain_apply(op_, in_[0].data(), in_[1].data(), in_[2].data(), in_[3].data(), in_[4].data(),
                in_[5].data(), x, y, p);
  }
  double error(const Problem& problem) const override {
    const std::vector<float> ours = problem.out.values();
    const auto size = Eigen::Index(ours.size());
    return oracle::relative_error(
        Eigen::Map<const Eigen::VectorXf>(out_.data(), size).cast<double>(),
        Eigen::Map<const Eigen::VectorXf>(ours.data(), size).cast<double>());
  }

 private:
  std::vector<std::vector<float>> in_;
  std::vector<float> out_;
  PlainOperator op_;
};

/// The oracle's matrix by compressed rows, and a vector.
template <class T>
struct Assembled {
  oracle::KernelOracle oracle;
  std::vector<int> begin, column;
  std::vector<T> value, in, out;

  explicit Assembled(const Problem& problem) : oracle(oracle::kernel_oracle(problem.level)) {
    const Matrix rows = oracle.matrix;
    begin.assign(rows.outerIndexPtr(), rows.outerIndexPtr() + rows.rows() + 1);
    column.assign(rows.innerIndexPtr(), rows.innerIndexPtr() + rows.nonZeros());
    value.assign(rows.valuePtr(), rows.valuePtr() + rows.nonZeros());
    const VectorXd d = oracle.packed<float>(problem.level.d.view());
    in.assign(d.begin(), d.end());
    out.resize(in.size());
  }
  double error(const Problem& problem) const {
    VectorXd found(Eigen::Index(out.size()));
    for (Eigen::Index k = 0; k < found.size(); ++k) found[k] = double(out[std::size_t(k)]);
    return oracle::relative_error(found, oracle.packed<float>(problem.out.view()));
  }
};

class EigenMatrix : public Product {
 public:
  explicit EigenMatrix(const Problem& problem) : data_(problem) {}
  std::string name() const override { return "Eigen SparseMatrix, float, by rows"; }
  void run() override {
    eigen_apply(int(data_.in.size()), data_.begin.data(), data_.column.data(), data_.value.data(),
                data_.in.data(), data_.out.data());
  }
  double error(const Problem& problem) const override { return data_.error(problem); }

 private:
  Assembled<float> data_;
};

#if DRUMHEAD_BENCH_PETSC
/// Debian's PETSc computes in double.
class PetscMatrix : public Product {
 public:
  explicit PetscMatrix(const Problem& problem) : data_(problem) {
    PetscInitializeNoArguments();
    const auto rows = PetscInt(data_.in.size());
    MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, rows, rows, data_.begin.data(), data_.column.data(),
                              data_.value.data(), &matrix_);
    VecCreateSeqWithArray(PETSC_COMM_SELF, 1, rows, data_.in.data(), &in_);
    VecCreateSeqWithArray(PETSC_COMM_SELF, 1, rows, data_.out.data(), &out_);
  }
  ~PetscMatrix() override {
    VecDestroy(&in_);
    VecDestroy(&out_);
    MatDestroy(&matrix_);
  }
  PetscMatrix(const PetscMatrix&) = delete;
  PetscMatrix& operator=(const PetscMatrix&) = delete;
  std::string name() const override { return "PETSc AIJ, double"; }
  void run() override { MatMult(matrix_, in_, out_); }
  double error(const Problem& problem) const override { return data_.error(problem); }

 private:
  Assembled<double> data_;
  Mat matrix_ = nullptr;
  Vec in_ = nullptr, out_ = nullptr;
};
#endif

std::unique_ptr<Product> make_product(Contender which, const Problem& problem) {
  if (which == Contender::plain_loop) return std::make_unique<PlainLoop>(problem);
#if DRUMHEAD_BENCH_PETSC
  if (which == Contender::petsc) return std::make_unique<PetscMatrix>(problem);
#endif
  return std::make_unique<EigenMatrix>(problem);
}

}  // namespace

std::vector<Contender> contenders() {
#if DRUMHEAD_BENCH_PETSC
  return {Contender::plain_loop, Contender::eigen, Contender::petsc};
#else
  return {Contender::plain_loop, Contender::eigen};
#endif
}

Competitor::Competitor(Contender which, int n)
    : problem_(std::make_unique<Problem>(n)), product_(make_product(which, *problem_)) {}

Competitor::~Competitor() = default;

std::string Competitor::name() const { return product_->name(); }

std::size_t Competitor::nodes() const {
  const std::size_t side = std::size_t(problem_->level.spec.nx) + 1;
  return side * side;
}

void Competitor::run() const { product_->run(); }

void Competitor::run_ours() const {
  kernels::apply_hessian<float>(problem_->level.membrane(), std::as_const(problem_->level.d).view(),
                                problem_->out.view());
}

bool Competitor::right() const {
  constexpr double kRounding = 2e-5;  // of float, a few dozen operations
  for (const kernels::Isa isa : kernels::available_isas()) {
    const fields::ForcedIsa forced(isa);
    run_ours();
    product_->run();
    if (!(product_->error(*problem_) < kRounding)) return false;
  }
  return true;
}

}  // namespace drumhead::bench
