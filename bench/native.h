// SPDX-License-Identifier: MIT
#pragma once
// Competitors compiled at -O3 -march=native. They take plain pointers and allocate nothing, so that
// no code of Eigen's is shared with objects compiled for other processors.

namespace drumhead::bench {

struct PlainOperator {
  int n = 0;  ///< cells along each side; node arrays have n + 1 columns, cell arrays n
  float mu = 1.0f, spacing = 1.0f, compliance = 0.0f, clamp_centre = 0.0f, clamp_width = 1.0f;
};

/// out = H d, constant mu and kappa; nodes on the boundary are not written. What a good programmer
/// writes in an afternoon: ordinary row-major arrays, every pointer restrict, one loop a row.
void plain_apply(const PlainOperator& op, const float* ux, const float* uy, const float* pressure,
                 const float* dx, const float* dy, const float* dp, float* out_x, float* out_y,
                 float* out_p);

/// out = A in by Eigen's product of a sparse matrix of `rows` compressed rows.
void eigen_apply(int rows, const int* begin, const int* column, const float* value, const float* in,
                 float* out);

}  // namespace drumhead::bench
