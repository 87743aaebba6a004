// SPDX-License-Identifier: MIT
#include "amg_solver.h"

#include <malloc.h>
#include <petscksp.h>

#include <algorithm>
#include <utility>

#include <Eigen/SparseCholesky>

namespace drumhead::bench {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Columns = Eigen::SparseMatrix<double>;
using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr double kGamma = 4.0;  // in units of mu
constexpr int kMostIterations = 2000;

double allocated() {
  const struct mallinfo2 info = mallinfo2();
  return double(info.uordblks) + double(info.hblkhd);
}

/// [H Bᵀ Wᵀ; B −compliance 0; W 0 −M], x̂ interleaved.
struct Blocks {
  Columns H, B, W, M;   ///< M >= 0
  VectorXd compliance;  ///< 1/kappa of P
};

using Order = Eigen::PermutationMatrix<Eigen::Dynamic>;

Order interleaved(const oracle::OracleScene& scene) {
  Order order(scene.unknowns());
  for (int k = 0; k < scene.unknowns(); ++k) order.indices()[k] = k;
  for (int k = 0; k < scene.free_nodes; ++k) {
    order.indices()[k] = 2 * k;
    order.indices()[k + scene.free_nodes] = 2 * k + 1;
  }
  return order;
}

Blocks blocks_of(const oracle::OracleScene& scene, const oracle::OracleSystem& linear,
                 const Order& order) {
  Columns matrix;
  matrix = linear.matrix.twistedBy(order);
  const Index nx = 2 * scene.free_nodes, np = scene.pressures, nq = matrix.rows() - nx - np;
  Blocks b;
  b.H = matrix.block(0, 0, nx, nx);
  b.B = matrix.block(nx, 0, np, nx);
  b.W = matrix.block(nx + np, 0, nq, nx);
  b.M = -Columns(matrix.block(nx + np, nx + np, nq, nq));
  b.compliance = -VectorXd(matrix.diagonal().segment(nx, np));
  return b;
}

/// [A Cᵀ; C −M] by rows.
Rows saddle(const Columns& A, const Columns& C, const Columns& M) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](const Columns& block, Index row, Index column, double sign, bool turned) {
    for (Index k = 0; k < block.outerSize(); ++k)
      for (Columns::InnerIterator it(block, k); it; ++it) {
        const Index r = turned ? it.col() : it.row(), c = turned ? it.row() : it.col();
        entries.emplace_back(int(row + r), int(column + c), sign * it.value());
      }
  };
  add(A, 0, 0, 1.0, false);
  add(C, A.rows(), 0, 1.0, false);
  add(C, 0, A.rows(), 1.0, true);
  add(M, A.rows(), A.rows(), -1.0, false);
  Rows matrix(A.rows() + C.rows(), A.rows() + C.rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// PETSc's window on a matrix, which must outlive it.
Mat window(Rows& matrix) {
  matrix.makeCompressed();
  Mat result = nullptr;
  MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, PetscInt(matrix.rows()), PetscInt(matrix.cols()),
                            matrix.outerIndexPtr(), matrix.innerIndexPtr(), matrix.valuePtr(),
                            &result);
  return result;
}

/// The preconditioner: AMG for x̂, a factorised band for the rest.
class Preconditioner {
 public:
  Preconditioner(Amg amg, Rows leading, const Columns& rest)
      : leading_(std::move(leading)), rest_(rest) {
    matrix_ = window(leading_);
    MatSetBlockSize(matrix_, 2);
    PCCreate(PETSC_COMM_SELF, &amg_);
    PCSetType(amg_, amg == Amg::gamg ? PCGAMG : PCHYPRE);
    if (amg == Amg::boomeramg) PCHYPRESetType(amg_, "boomeramg");
    PCSetFromOptions(amg_);
    PCSetOperators(amg_, matrix_, matrix_);
    PCSetUp(amg_);
  }
  ~Preconditioner() {
    PCDestroy(&amg_);
    MatDestroy(&matrix_);
  }
  Preconditioner(const Preconditioner&) = delete;
  Preconditioner& operator=(const Preconditioner&) = delete;

  /// Of the matrix that the hierarchy was made from.
  Index entries() const { return leading_.nonZeros(); }

  static PetscErrorCode apply(PC pc, Vec in, Vec out) {
    Preconditioner* self = nullptr;
    PCShellGetContext(pc, &self);
    const PetscScalar* from = nullptr;
    PetscScalar* to = nullptr;
    VecGetArrayRead(in, &from);
    VecGetArray(out, &to);
    const Index leading = self->leading_.rows(), rest = self->rest_.rows();
    Vec x = nullptr, y = nullptr;
    VecCreateSeqWithArray(PETSC_COMM_SELF, 2, PetscInt(leading), from, &x);
    VecCreateSeqWithArray(PETSC_COMM_SELF, 2, PetscInt(leading), to, &y);
    PCApply(self->amg_, x, y);
    VecDestroy(&x);
    VecDestroy(&y);
    Eigen::Map<VectorXd>(to + leading, rest) =
        self->rest_.solve(Eigen::Map<const VectorXd>(from + leading, rest));
    VecRestoreArrayRead(in, &from);
    VecRestoreArray(out, &to);
    return 0;
  }

 private:
  Rows leading_;
  Eigen::SimplicialLDLT<Columns> rest_;
  Mat matrix_ = nullptr;
  PC amg_ = nullptr;
};

/// MINRES; returns the solution.
VectorXd iterate(Rows& matrix, const VectorXd& right, Preconditioner& by, double reduction,
                 AmgCost& cost) {
  VectorXd x = VectorXd::Zero(right.size());
  Mat system = window(matrix);
  Vec b = nullptr, solution = nullptr;
  VecCreateSeqWithArray(PETSC_COMM_SELF, 1, PetscInt(right.size()), right.data(), &b);
  VecCreateSeqWithArray(PETSC_COMM_SELF, 1, PetscInt(x.size()), x.data(), &solution);
  KSP krylov = nullptr;
  KSPCreate(PETSC_COMM_SELF, &krylov);
  KSPSetType(krylov, KSPMINRES);
  KSPSetTolerances(krylov, reduction, 1e-300, PETSC_DEFAULT, kMostIterations);
  PC shell = nullptr;
  KSPGetPC(krylov, &shell);
  PCSetType(shell, PCSHELL);
  PCShellSetContext(shell, &by);
  PCShellSetApply(shell, Preconditioner::apply);
  KSPSetOperators(krylov, system, system);
  KSPSolve(krylov, b, solution);
  PetscInt iterations = 0;
  KSPGetIterationNumber(krylov, &iterations);
  KSPConvergedReason reason{};
  KSPGetConvergedReason(krylov, &reason);
  cost.last_iterations = int(iterations);
  cost.iterations += int(iterations);
  cost.solved &= reason > 0;
  KSPDestroy(&krylov);
  VecDestroy(&b);
  VecDestroy(&solution);
  MatDestroy(&system);
  return x;
}

}  // namespace

AmgSolver::AmgSolver(Amg amg, double reduction) : amg_(amg), reduction_(reduction) {
  PetscInitializeNoArguments();
  // With Jacobi, GAMG's own, up to twice the iterations.
  PetscOptionsSetValue(nullptr, "-mg_levels_pc_type", "sor");
}

VectorXd AmgSolver::operator()(const NewtonSystem& system) {
  const oracle::OracleScene& scene = system.scene;
  const Order order = interleaved(scene);
  const Blocks blocks = blocks_of(scene, system.linear, order);
  const VectorXd right = order * VectorXd(-system.linear.gradient);
  const Index nx = blocks.H.rows(), np = blocks.B.rows(), nq = blocks.W.rows();
  const VectorXd kappa = blocks.compliance.cwiseInverse(), right_P = right.segment(nx, np);
  VectorXd reduced(nx + nq);
  reduced << right.head(nx) + blocks.B.transpose() * kappa.cwiseProduct(right_P), right.tail(nq);

  // The preconditioner's Hessian is clamped.
  Columns clamped_H = blocks.H;
  if (system.theta > 1.0)
    clamped_H =
        blocks_of(scene, oracle::assemble(scene, system.state, clamped(system.state.P, 1.0)), order)
            .H;
  const Columns BB = blocks.B.transpose() * kappa.asDiagonal() * blocks.B;
  const Columns WW = blocks.W.transpose() * blocks.W;
  Columns rest(nq, nq);
  rest.setIdentity();
  rest = blocks.M + (1.0 / kGamma) * rest;
  Rows matrix = saddle(blocks.H + BB, blocks.W, blocks.M);
  Rows leading = clamped_H + BB + kGamma * WW;

  const double before = allocated(), start = now();
  Preconditioner by(amg_, std::move(leading), rest);
  const double ready = now();
  const VectorXd found = iterate(matrix, reduced, by, reduction_, cost_);
  const double entries = double(matrix.nonZeros() + by.entries());
  cost_.bytes =
      std::max(cost_.bytes, allocated() - before + entries * (sizeof(double) + sizeof(int)));
  cost_.setup_seconds += ready - start;
  cost_.iterate_seconds += now() - ready;
  ++cost_.systems;
  VectorXd step(nx + np + nq);
  step << found.head(nx), kappa.cwiseProduct(blocks.B * found.head(nx) - right_P), found.tail(nq);
  return order.transpose() * step;
}

}  // namespace drumhead::bench
