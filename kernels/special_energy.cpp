// SPDX-License-Identifier: MIT
#include "special_energy.h"

#include <algorithm>

#include "special_state.h"

namespace drumhead::kernels {
namespace {

/// A (J − 1) of a part: twice it is Σ X_k × w_k+1 + w_k × X_k+1 + w_k × w_k+1 along its boundary.
template <class T, class F>
T volume_change(const SpecialCells<T>& cells, int part, F&& displacement) {
  const std::size_t begin = std::size_t(cells.vertex_begin[std::size_t(part)]),
                    end = std::size_t(cells.vertex_begin[std::size_t(part) + 1]);
  T twice = T(0);
  const PartVertex<T>* last = &cells.vertex[end - 1];
  Vector2<T> u = displacement(last->vertex);
  for (std::size_t v = begin; v < end; ++v) {
    const PartVertex<T>& next = cells.vertex[v];
    const Vector2<T> w = displacement(next.vertex);
    twice +=
        (last->x * w.y - last->y * w.x) + (u.x * next.y - u.y * next.x) + (u.x * w.y - u.y * w.x);
    last = &next;
    u = w;
  }
  return T(0.5) * twice;
}

/// visit(strength, neighbour) for the parts that the equations join with part p by a jump.
template <class T, class F>
void for_own_jumps(const SpecialRows<T>& rows, int p, F&& visit) {
  const SpecialCells<T>& cells = rows.cells();
  for (int k = cells.neighbour_begin[std::size_t(p)]; k < cells.neighbour_begin[std::size_t(p) + 1];
       ++k)
    if (const T strength = rows.own_jump(k); strength != T(0))
      visit(strength, cells.neighbour[std::size_t(k)].part);
}

/// −∂E/∂x̂ of the regular cells around near node (i, j), added without branches, which nothing
/// foretells.
template <class T>
Vector2<T> regular_force(const Membrane<T>& m, const NearNode& node, int j) {
  const int i = node.column;
  const T h = m.spacing, x = m.ux.at(i, j), y = m.uy.at(i, j);
  // To the neighbours west and east, south and north.
  const Vector2<T> along[2] = {{-h + (m.ux.at(i - 1, j) - x), m.uy.at(i - 1, j) - y},
                               {h + (m.ux.at(i + 1, j) - x), m.uy.at(i + 1, j) - y}};
  const Vector2<T> up[2] = {{m.ux.at(i, j - 1) - x, -h + (m.uy.at(i, j - 1) - y)},
                            {m.ux.at(i, j + 1) - x, h + (m.uy.at(i, j + 1) - y)}};
  Vector2<T> sum{T(0), T(0)};
  for (int q = 0; q < 4; ++q) {
    const int ci = i - 1 + (q & 1), cj = j - 1 + (q >> 1);
    const T half_mu = T(0.5) * mu_at(m, ci, cj), regular = T(node.regular >> q & 1);
    const Vector2<T> a = along[q & 1], b = up[q >> 1];
    Vector2<T> force{half_mu * (a.x + b.x), half_mu * (a.y + b.y)};
    if (m.pressure) {
      // A J = ½ (next − previous) rotated · x̂ + …; the neighbour along x follows at corners 00, 11.
      const T half = T(q == 0 || q == 3 ? 0.5 : -0.5) * m.pressure.at(ci, cj);
      force.x -= half * (a.y - b.y);
      force.y += half * (a.x - b.x);
    }
    sum.x += regular * force.x;
    sum.y += regular * force.y;
  }
  return sum;
}

template <class T>
void add_triangle_force(const SpecialCells<T>& cells, const CellState<T>& u, T mu, int n,
                        CellForce<T>& force) {
  for (int t = cells.triangle_begin[std::size_t(n)]; t < cells.triangle_begin[std::size_t(n) + 1];
       ++t) {
    const Triangle<T>& triangle = cells.triangle[std::size_t(t)];
    const Gradient<T> g = gradient<T>(triangle, 3, u);
    const T scale = mu * triangle.area;
    for (std::size_t a = 0; a < 3; ++a) {
      const T gx = triangle.gx[a], gy = triangle.gy[a];
      force.add(triangle.vertex[a], {-(scale * (gx + (g.xx * gx + g.xy * gy))),
                                     -(scale * (gy + (g.yx * gx + g.yy * gy)))});
    }
  }
}

/// True if the part's area is negative.
template <class T>
bool add_part_force(const Membrane<T>& m, const CellState<T>& u, T compliance, int p,
                    CellForce<T>& force, const Unknowns<T>& f) {
  const SpecialRows<T>& rows = *m.special;
  const SpecialCells<T>& cells = rows.cells();
  const int begin = cells.vertex_begin[std::size_t(p)],
            end = cells.vertex_begin[std::size_t(p) + 1];
  const T half = T(0.5) * m.listed[p];
  for (int v = begin; v < end; ++v) {
    const PartVertex<T>& next = cells.vertex[std::size_t(v + 1 < end ? v + 1 : begin)];
    const PartVertex<T>& previous = cells.vertex[std::size_t(v > begin ? v - 1 : end - 1)];
    const Vector2<T> to = u(next.vertex), from = u(previous.vertex);
    force.add(cells.vertex[std::size_t(v)].vertex,
              {-(half * ((next.y - previous.y) + (to.y - from.y))),
               half * ((next.x - previous.x) + (to.x - from.x))});
  }
  const T area = cells.area[std::size_t(p)], change = volume_change(cells, p, u);
  f.listed[p] = area * compliance * m.listed[p] - change;
  for_own_jumps(rows, p, [&](T strength, int other) {
    f.listed[p] += strength * (m.listed[p] - m.listed[other]);
  });
  return change < -area;
}

}  // namespace

template <class T>
void add_spring_force(const SpecialCells<T>& cells, const Unknowns<T>& f) {
  for (int j = 0; j + 1 < int(cells.held_begin.size()); ++j)
    for (int k = cells.held_begin[std::size_t(j)]; k < cells.held_begin[std::size_t(j) + 1]; ++k) {
      const HeldNode<T>& node = cells.held[std::size_t(k)];
      if (node.known()) continue;
      f.x.at(node.place, j) -= node.stiffness * node.off_x;
      f.y.at(node.place, j) -= node.stiffness * node.off_y;
    }
  for (int c = 0; c < f.curve_count / 2; ++c) {
    const HeldNode<T>& node = cells.crossing[std::size_t(c)];
    f.curve[2 * c] = node.known() ? T(0) : -node.stiffness * node.off_x;
    f.curve[2 * c + 1] = node.known() ? T(0) : -node.stiffness * node.off_y;
  }
}

template <class T>
void clear_special_force(const Membrane<T>& m, const Unknowns<T>& f, int j) {
  for (const int i : special_columns(m.special->cells(), j))
    f.p.at(i, j) = m.spacing * m.spacing * compliance_at(m, i, j) * m.pressure.at(i, j);
}

template <class T>
int special_force(const Membrane<T>& m, const Unknowns<T>& f) {
  const SpecialRows<T>& rows = *m.special;
  int inverted = 0;
  for (int j = 1; j + 1 < m.ux.rows; ++j) {
    for (const int i : rows.known(j)) f.x.at(i, j) = f.y.at(i, j) = T(0);
    for (int n = rows.near_begin(j); n < rows.near_begin(j + 1); ++n) {
      const NearNode& node = rows.near_node(n);
      const Vector2<T> sum = regular_force(m, node, j);
      f.x.at(node.column, j) = sum.x;
      f.y.at(node.column, j) = sum.y;
    }
  }
  add_spring_force(rows.cells(), f);
  for_special(rows.cells(), [&](int n, int i, int j) {
    const CellState<T> u(rows.cells(), m.ux, m.uy, i, j);
    CellForce<T> force(f, rows, n, i, j);
    add_triangle_force(rows.cells(), u, mu_at(m, i, j), n, force);
    if (m.pressure) {
      const T compliance = compliance_at(m, i, j);
      f.p.at(i, j) = T(0);
      bool any = false;
      for_parts(rows.cells(), n,
                [&](int p) { any |= add_part_force(m, u, compliance, p, force, f); });
      inverted += any;
    }
    force.store();
  });
  return inverted;
}

template <class T>
void add_spring_energy(const SpecialRows<T>& rows, const Unknowns<const T>& d, T step,
                       EnergySums& sums, int j) {
  const SpecialCells<T>& cells = rows.cells();
  auto add = [&](const HeldNode<T>& node, T dx, T dy) {
    const T x = node.off_x + step * dx, y = node.off_y + step * dy;
    sums.constraint +=
        0.5 * double(node.stiffness) * (double(x) * double(x) + double(y) * double(y));
  };
  for (int k = cells.held_begin[std::size_t(j)]; k < cells.held_begin[std::size_t(j) + 1]; ++k)
    if (const HeldNode<T>& node = cells.held[std::size_t(k)]; !node.known())
      add(node, d.x ? d.x.at(node.place, j) : T(0), d.x ? d.y.at(node.place, j) : T(0));
  if (!rows.soft()) return;
  for (int n = rows.soft()->begin(j); n < rows.soft()->begin(j + 1); ++n) {
    const int c = rows.soft()->row(n).node;
    add(cells.crossing[std::size_t(c)], d.x ? d.curve[2 * c] : T(0),
        d.x ? d.curve[2 * c + 1] : T(0));
  }
}

/// Energies of part p, A (J − 1) = `change`, with compliance c0. Joined parts have the Lagrangian's
/// at their pressures, since the least energy of one is no longer A (J − 1)²/(2 c0).
template <class T>
void add_part_energy(const Membrane<T>& m, const Unknowns<const T>& d, int p, double c0,
                     double change, EnergySums& sums) {
  const double soft = 0.01 / double(m.mu.value);  // as in energy_row
  const double area = double(m.special->cells().area[std::size_t(p)]);
  const auto pressure_of = [&](int n) {
    return double(m.listed[n]) + (d.listed ? double(d.listed[n]) : 0.0);
  };
  const double pressure = pressure_of(p);
  double jumps = 0.0, squares = 0.0;
  bool joined = false;
  for_own_jumps(*m.special, p, [&](T strength, int other) {
    const double jump = pressure - pressure_of(other);
    jumps += double(strength) * jump;
    squares += double(strength) * jump * jump;
    joined = true;
  });
  const double c = change / area - pressure * c0 - jumps / area;
  sums.volume_merit += c0 < soft || joined
                           ? area * (pressure * c + 0.5 * c * c / std::max(c0, soft))
                           : 0.5 * change * change / (area * c0);
  if (joined)
    sums.volume += pressure * change - 0.5 * area * c0 * pressure * pressure - 0.25 * squares;
  else if (c0 > 0.0)
    sums.volume += 0.5 * change * change / (area * c0);
}

template <class T>
void add_special_energy(const Membrane<T>& m, const Unknowns<const T>& d, T step, EnergySums& sums,
                        int j) {
  const SpecialCells<T>& cells = m.special->cells();
  for (int n = cells.row_begin[std::size_t(j)]; n < cells.row_begin[std::size_t(j) + 1]; ++n) {
    const int i = cells.column[std::size_t(n)];
    const CellState<T> displacement(cells, m.ux, m.uy, i, j, d, step);
    for (int t = cells.triangle_begin[std::size_t(n)]; t < cells.triangle_begin[std::size_t(n) + 1];
         ++t) {
      const Triangle<T>& triangle = cells.triangle[std::size_t(t)];
      const Gradient<T> g = gradient<T>(triangle, 3, displacement);
      const T xx = T(1) + g.xx, yy = T(1) + g.yy;
      sums.elastic += 0.5 * double(mu_at(m, i, j)) * double(triangle.area) *
                      double((xx * xx + yy * yy) + (g.xy * g.xy + g.yx * g.yx));
    }
    const double c0 = double(compliance_at(m, i, j));
    bool inverted = false;
    for_parts(cells, n, [&](int p) {
      const double change = double(volume_change(cells, p, displacement));
      inverted = inverted || change < -double(cells.area[std::size_t(p)]);
      if (m.pressure) add_part_energy(m, d, p, c0, change, sums);
    });
    sums.inverted_cells += inverted;
  }
  add_spring_energy(*m.special, d, step, sums, j);
}

#define DRUMHEAD_INSTANTIATE(T)                                                                    \
  template void add_spring_force(const SpecialCells<T>&, const Unknowns<T>&);                      \
  template void add_spring_energy(const SpecialRows<T>&, const Unknowns<const T>&, T, EnergySums&, \
                                  int);                                                            \
  template int special_force(const Membrane<T>&, const Unknowns<T>&);                              \
  template void clear_special_force(const Membrane<T>&, const Unknowns<T>&, int);                  \
  template void add_special_energy(const Membrane<T>&, const Unknowns<const T>&, T, EnergySums&,   \
                                   int);
DRUMHEAD_INSTANTIATE(float)
DRUMHEAD_INSTANTIATE(double)
#undef DRUMHEAD_INSTANTIATE

}  // namespace drumhead::kernels
