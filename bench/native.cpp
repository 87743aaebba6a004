// SPDX-License-Identifier: MIT
#include "native.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cstddef>

namespace drumhead::bench {
namespace {

/// Rows j−1, j, j+1 of a node array.
struct NodeRows {
  const float *below, *here, *above;
  NodeRows(const float* field, int n, int j)
      : below(field + std::ptrdiff_t(j - 1) * (n + 1)),
        here(below + (n + 1)),
        above(here + (n + 1)) {}
};

void node_row(const PlainOperator& op, const NodeRows& ux, const NodeRows& uy,
              const float* __restrict p0, const float* __restrict p1, const NodeRows& dx,
              const NodeRows& dy, const float* __restrict q0, const float* __restrict q1,
              float* __restrict out_x, float* __restrict out_y) {
  const float* __restrict xs = dx.below, * __restrict xc = dx.here, * __restrict xn = dx.above;
  const float* __restrict ys = dy.below, * __restrict yc = dy.here, * __restrict yn = dy.above;
  const float* __restrict us = ux.below, * __restrict uc = ux.here, * __restrict un = ux.above;
  const float* __restrict vs = uy.below, * __restrict vc = uy.here, * __restrict vn = uy.above;
  const float mu = op.mu, h = op.spacing, middle = op.clamp_centre, bound = op.clamp_width * op.mu;
  for (int i = 1; i < op.n; ++i) {
    const auto clamped = [=](float p) { return std::max(std::min(p - middle, bound), -bound); };
    const float sw = clamped(p0[i - 1]), se = clamped(p0[i]), nw = clamped(p1[i - 1]),
                ne = clamped(p1[i]);
    const float w = sw - nw, e = ne - se, s = se - sw, n = nw - ne;
    const float dw = q0[i - 1] - q1[i - 1], de = q1[i] - q0[i], ds = q0[i] - q0[i - 1],
                dn = q1[i - 1] - q1[i];
    const float gx = w * yc[i - 1] + e * yc[i + 1] + s * ys[i] + n * yn[i];
    const float gy = w * xc[i - 1] + e * xc[i + 1] + s * xs[i] + n * xn[i];
    const float bx = dw * vc[i - 1] + de * vc[i + 1] + ds * vs[i] + dn * vn[i] + h * (dn - ds);
    const float by = dw * uc[i - 1] + de * uc[i + 1] + ds * us[i] + dn * un[i] + h * (de - dw);
    const float lx = 4.0f * xc[i] - (xc[i - 1] + xc[i + 1] + xs[i] + xn[i]);
    const float ly = 4.0f * yc[i] - (yc[i - 1] + yc[i + 1] + ys[i] + yn[i]);
    out_x[i] = mu * lx + 0.5f * (gx + bx);
    out_y[i] = mu * ly - 0.5f * (gy + by);
  }
}

void cell_row(const PlainOperator& op, const float* __restrict u0, const float* __restrict u1,
              const float* __restrict v0, const float* __restrict v1, const float* __restrict x0,
              const float* __restrict x1, const float* __restrict y0, const float* __restrict y1,
              const float* __restrict q, float* __restrict out) {
  const float h = op.spacing, c = h * h * op.compliance;
  for (int i = 0; i < op.n; ++i) {
    const float d1x = u1[i + 1] - u0[i] + h, d1y = v1[i + 1] - v0[i] + h;
    const float d2x = u1[i] - u0[i + 1] - h, d2y = v1[i] - v0[i + 1] + h;
    const float e1x = x1[i + 1] - x0[i], e1y = y1[i + 1] - y0[i];
    const float e2x = x1[i] - x0[i + 1], e2y = y1[i] - y0[i + 1];
    out[i] = 0.5f * (d1x * e2y - d1y * e2x + e1x * d2y - e1y * d2x) - c * q[i];
  }
}

}  // namespace

void plain_apply(const PlainOperator& op, const float* ux, const float* uy, const float* pressure,
                 const float* dx, const float* dy, const float* dp, float* out_x, float* out_y,
                 float* out_p) {
  const int n = op.n;
  for (int j = 0; j < n; ++j) {
    const std::ptrdiff_t node = std::ptrdiff_t(j) * (n + 1), next = node + n + 1;
    const std::ptrdiff_t cell = std::ptrdiff_t(j) * n, before = cell - n;
    if (j > 0)
      node_row(op, {ux, n, j}, {uy, n, j}, pressure + before, pressure + cell, {dx, n, j},
               {dy, n, j}, dp + before, dp + cell, out_x + node, out_y + node);
    cell_row(op, ux + node, ux + next, uy + node, uy + next, dx + node, dx + next, dy + node,
             dy + next, dp + cell, out_p + cell);
  }
}

void eigen_apply(int rows, const int* begin, const int* column, const float* value, const float* in,
                 float* out) {
  using Matrix = Eigen::SparseMatrix<float, Eigen::RowMajor>;
  const Eigen::Map<const Matrix> matrix(rows, rows, begin[rows], begin, column, value);
  const Eigen::Map<const Eigen::VectorXf> x(in, rows);
  Eigen::Map<Eigen::VectorXf> y(out, rows);
  y.noalias() = matrix * x;
}

}  // namespace drumhead::bench
