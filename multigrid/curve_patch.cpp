// SPDX-License-Identifier: MIT
#include "curve_patch.h"

#include <algorithm>
#include <array>
#include <utility>

#include <drumhead/kernels/cuts.h>

#include "envelope.h"

namespace drumhead::multigrid {
namespace {

// Cells around each cut one whose volume rows belong to the block. S4, kappa 1e4, 32²: 1428 cycles
// with those of the cut cells alone, 458 with their neighbours; without any, S2 does not converge.
constexpr int kReach = 1;
// Shift of the diagonal, relative to its largest entry: rows may depend on one another, and a cell
// that has collapsed to a point has an empty one.
constexpr double kShift = 1e-8;

struct Place {
  int i, j;
};

/// Numbers places of a grid in the order in which they are first met.
class Numbering {
 public:
  Numbering(int columns, int rows)
      : columns_(columns), rows_(rows), number_(std::size_t(columns) * std::size_t(rows), -1) {}
  bool inside(int i, int j) const { return i >= 0 && j >= 0 && i < columns_ && j < rows_; }
  int of(int i, int j) {
    int& number = number_[std::size_t(j) * std::size_t(columns_) + std::size_t(i)];
    if (number < 0) {
      number = int(places.size());
      places.push_back({i, j});
    }
    return number;
  }
  std::vector<Place> places;

 private:
  int columns_, rows_;
  std::vector<int> number_;
};

/// Entries of C, M and D⁻¹, from a level's geometry.
template <class T>
class Assembly {
 public:
  explicit Assembly(const kernels::LevelSystem<T>& level)
      : level_(level),
        m_(level.membrane),
        nodes(level.d.x.columns, level.d.x.rows),
        cells(level.d.x.columns - 1, level.d.x.rows - 1) {
    if (level.d.p) find_cells();
    volume_rows = int(cells.places.size());
    add_curve_rows();
    for (int row = 0; row < volume_rows; ++row) add_volume_row(row);
    add_inverse_diagonal();
  }

 private:
  const kernels::LevelSystem<T>& level_;
  const kernels::Membrane<T>& m_;

 public:
  Numbering nodes, cells;  ///< those of the volume rows first, then those beside them
  int volume_rows = 0;
  SparseRows c, m;
  std::vector<std::array<double, 3>> inverse;  ///< D⁻¹ of each node: xx, xy, yy

 private:
  void find_cells() {
    const kernels::Cuts<T>& cuts = level_.cuts;
    for (int j = 0; j + 1 < level_.d.x.rows; ++j)
      for (int k = cuts.row_begin[j]; k < cuts.row_begin[j + 1]; ++k)
        for (int b = j - kReach; b <= j + kReach; ++b)
          for (int a = cuts.column[k] - kReach; a <= cuts.column[k] + kReach; ++a)
            if (cells.inside(a, b)) cells.of(a, b);
  }
  /// Nodes of the fixed boundary do not move: they have no column.
  void add_entry(int i, int j, double x, double y) {
    if (i == 0 || j == 0 || i + 1 == level_.d.x.columns || j + 1 == level_.d.x.rows) return;
    const int node = nodes.of(i, j);
    if (x != 0.0) c.add(2 * node, x);
    if (y != 0.0) c.add(2 * node + 1, y);
  }
  void end_row() {
    c.end_row();
    m.end_row();
  }
  void add_curve_rows() {
    const kernels::Cuts<T>& cuts = level_.cuts;
    for (int j = 0; j + 1 < level_.d.x.rows; ++j)
      for (int k = cuts.row_begin[j]; k < cuts.row_begin[j + 1]; ++k)
        for (int axis = 0; axis < 2; ++axis) {
          for (int n = 0; n < 4; ++n) {
            const double w = -double(cuts.weight[4 * k + n]);
            add_entry(cuts.column[k] + (n & 1), j + (n >> 1), axis == 0 ? w : 0.0,
                      axis == 1 ? w : 0.0);
          }
          m.add(2 * k + axis, double(kernels::cut_compliance_diagonal(cuts, k)));
          for (int l = cuts.link_begin[k]; l < cuts.link_begin[k + 1]; ++l)
            m.add(2 * cuts.link[l] + axis, -double(cuts.jump) * double(cuts.link_strength[l]));
          end_row();
        }
  }
  /// B d − A/kappa dP − the jump between pressures (relax_body.h, pressure_jump.h).
  void add_volume_row(int number) {
    const int i = cells.places[std::size_t(number)].i, j = cells.places[std::size_t(number)].j;
    const int row = 2 * level_.cuts.count + number;  // and its own column of M
    const double h = double(m_.spacing);
    auto x = [&](int a, int b) { return h * a + double(m_.ux.at(i + a, j + b)); };
    auto y = [&](int a, int b) { return h * b + double(m_.uy.at(i + a, j + b)); };
    const double d1x = x(1, 1) - x(0, 0), d1y = y(1, 1) - y(0, 0), d2x = x(0, 1) - x(1, 0),
                 d2y = y(0, 1) - y(1, 0);
    add_entry(i + 1, j + 1, 0.5 * d2y, -0.5 * d2x);
    add_entry(i, j, -0.5 * d2y, 0.5 * d2x);
    add_entry(i, j + 1, -0.5 * d1y, 0.5 * d1x);
    add_entry(i + 1, j, 0.5 * d1y, -0.5 * d1x);
    double diagonal = h * h * coefficient(m_.compliance, i, j);
    auto edge = [&](int a, int b, double ex, double ey) {
      if (m_.pressure_jump == T(0) || !cells.inside(i + a, j + b)) return;
      const double weight = 0.125 * double(m_.pressure_jump) * (ex * ex + ey * ey) /
                            (coefficient(m_.mu, i, j) + coefficient(m_.mu, i + a, j + b));
      diagonal += weight;
      m.add(2 * level_.cuts.count + cells.of(i + a, j + b), -weight);
    };
    edge(-1, 0, x(0, 1) - x(0, 0), y(0, 1) - y(0, 0));
    edge(1, 0, x(1, 1) - x(1, 0), y(1, 1) - y(1, 0));
    edge(0, -1, x(1, 0) - x(0, 0), y(1, 0) - y(0, 0));
    edge(0, 1, x(1, 1) - x(0, 1), y(1, 1) - y(0, 1));
    m.add(row, diagonal);
    end_row();
  }
  static double coefficient(const kernels::Coefficient<T>& field, int i, int j) {
    return double(field.cells ? field.cells.at(i, j) : field.value);
  }
  void add_inverse_diagonal() {
    for (const auto [i, j] : nodes.places) {
      if (m_.inverse_block[0]) {
        inverse.push_back({double(m_.inverse_block[0].at(i, j)),
                           double(m_.inverse_block[1].at(i, j)),
                           double(m_.inverse_block[2].at(i, j))});
        continue;
      }
      const double value = m_.inverse_diagonal ? double(m_.inverse_diagonal.at(i, j))
                                               : 1.0 / (4.0 * double(m_.mu.value));
      inverse.push_back({value, 0.0, value});
    }
  }
};

/// C D⁻¹ Cᵀ + M, of M the columns that are rows, too.
template <class T>
SparseRows normal_matrix(const Assembly<T>& assembly) {
  const SparseRows &c = assembly.c, &m = assembly.m;
  std::vector<std::vector<std::pair<int, double>>> column(2 * assembly.inverse.size());
  for (std::size_t r = 0; r + 1 < c.begin.size(); ++r)
    for (int e = c.begin[r]; e < c.begin[r + 1]; ++e)
      column[std::size_t(c.column[std::size_t(e)])].push_back({int(r), c.value[std::size_t(e)]});
  SparseRows product;
  for (std::size_t r = 0; r + 1 < c.begin.size(); ++r) {
    for (int e = c.begin[r]; e < c.begin[r + 1]; ++e) {
      const std::size_t at = std::size_t(c.column[std::size_t(e)]), axis = at % 2;
      const auto& inverse = assembly.inverse[at / 2];
      for (std::size_t other = 0; other < 2; ++other) {
        const double factor = c.value[std::size_t(e)] * inverse[axis + other];
        if (factor == 0.0) continue;
        for (const auto& [row, value] : column[at - axis + other]) product.add(row, factor * value);
      }
    }
    for (int e = m.begin[r]; e < m.begin[r + 1]; ++e)
      if (m.column[std::size_t(e)] < c.rows())
        product.add(m.column[std::size_t(e)], m.value[std::size_t(e)]);
    product.end_row();
  }
  return product;
}

/// Σ_e row_e x_e of row r.
double product(const SparseRows& matrix, std::size_t r, const std::vector<double>& x) {
  double sum = 0.0;
  for (int e = matrix.begin[r]; e < matrix.begin[r + 1]; ++e)
    sum += matrix.value[std::size_t(e)] * x[std::size_t(matrix.column[std::size_t(e)])];
  return sum;
}

}  // namespace

template <class T>
struct CurvePatch<T>::Block {
  std::vector<Place> node, cell;
  int volume_rows = 0;
  SparseRows c, m;
  std::vector<std::array<double, 3>> inverse;
  Envelope factors;
  std::vector<double> u, move, lambda, t;
  std::vector<T> force;  ///< −t of the curve rows
  grid::MemoryMeter* meter = nullptr;
  std::size_t bytes = 0;

  ~Block() { meter->remove(bytes); }
  void gather(const kernels::LevelSystem<T>& level);
  void solve();
  void scatter(const kernels::LevelSystem<T>& level);
};

template <class T>
CurvePatch<T>::~CurvePatch() = default;
template <class T>
CurvePatch<T>::CurvePatch(CurvePatch&&) noexcept = default;

template <class T>
CurvePatch<T>::CurvePatch(const kernels::LevelSystem<T>& level, grid::MemoryMeter& meter)
    : block_(std::make_unique<Block>()) {
  Assembly<T> assembly(level);
  Block& b = *block_;
  b.meter = &meter;
  b.factors.factorise(normal_matrix(assembly), kShift);
  b.node = std::move(assembly.nodes.places);
  b.cell = std::move(assembly.cells.places);
  b.volume_rows = assembly.volume_rows;
  b.c = std::move(assembly.c);
  b.m = std::move(assembly.m);
  b.inverse = std::move(assembly.inverse);
  const std::size_t curve = 2 * std::size_t(level.cuts.count);
  b.u.resize(2 * b.node.size());
  b.move.resize(b.u.size());
  b.lambda.resize(curve + b.cell.size());
  b.t.resize(std::size_t(b.c.rows()));
  b.force.resize(curve);
  b.bytes = b.c.bytes() + b.m.bytes() + b.factors.bytes() +
            (b.node.size() + b.cell.size()) * sizeof(Place) +
            b.inverse.size() * sizeof(b.inverse[0]) +
            (2 * b.u.size() + b.lambda.size() + b.t.size()) * sizeof(double) + curve * sizeof(T);
  meter.add(b.bytes);
}

template <class T>
void CurvePatch<T>::Block::gather(const kernels::LevelSystem<T>& level) {
  for (std::size_t n = 0; n < node.size(); ++n) {
    u[2 * n] = double(level.d.x.at(node[n].i, node[n].j));
    u[2 * n + 1] = double(level.d.y.at(node[n].i, node[n].j));
  }
  const std::size_t curve = force.size();
  for (std::size_t k = 0; k < curve; ++k) {
    lambda[k] = double(level.dq[k]);
    t[k] = double(level.fq[k]);
  }
  for (std::size_t n = 0; n < cell.size(); ++n) {
    const auto [i, j] = cell[n];
    lambda[curve + n] = double(level.d.p.at(i, j));
    if (n < std::size_t(volume_rows)) t[curve + n] = double(level.f.p.at(i, j));
  }
}

/// t := S⁻¹ (t − C u + M λ), u += D⁻¹ Cᵀ t.
template <class T>
void CurvePatch<T>::Block::solve() {
  for (std::size_t r = 0; r < t.size(); ++r) t[r] += product(m, r, lambda) - product(c, r, u);
  factors.solve(t);
  std::ranges::fill(move, 0.0);
  for (std::size_t r = 0; r < t.size(); ++r)
    for (int e = c.begin[r]; e < c.begin[r + 1]; ++e)
      move[std::size_t(c.column[std::size_t(e)])] += c.value[std::size_t(e)] * t[r];
  for (std::size_t n = 0; n < inverse.size(); ++n) {
    u[2 * n] += inverse[n][0] * move[2 * n] + inverse[n][1] * move[2 * n + 1];
    u[2 * n + 1] += inverse[n][1] * move[2 * n] + inverse[n][2] * move[2 * n + 1];
  }
}

template <class T>
void CurvePatch<T>::Block::scatter(const kernels::LevelSystem<T>& level) {
  for (std::size_t n = 0; n < node.size(); ++n) {
    level.d.x.at(node[n].i, node[n].j) = T(u[2 * n]);
    level.d.y.at(node[n].i, node[n].j) = T(u[2 * n + 1]);
  }
  const std::size_t curve = force.size();
  for (std::size_t k = 0; k < curve; ++k) {
    force[k] = T(-t[k]);
    level.dq[k] += force[k];
  }
  for (std::size_t n = 0; n < std::size_t(volume_rows); ++n)
    level.d.p.at(cell[n].i, cell[n].j) -= T(t[curve + n]);
  kernels::add_curve_force<T>(level.cuts, force.data(), T(1), level.f);
}

template <class T>
void CurvePatch<T>::relax(const kernels::LevelSystem<T>& level) {
  block_->gather(level);
  block_->solve();
  block_->scatter(level);
}

template class CurvePatch<float>;
template class CurvePatch<double>;

}  // namespace drumhead::multigrid
