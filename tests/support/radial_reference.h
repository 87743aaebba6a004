// SPDX-License-Identifier: MIT
#pragma once
// The exact warp of the roundabout (S2): between its circles r1, which turns by an angle, and r2,
// which is held, the deformed position is z(r) e^{i·angle of the point}, z complex, the minimum of
//
//     integral_r1^r2 [ 1/2 (|z'|² + |z|²/r²) + kappa/2 (Re(z̄ z')/r − 1)² ] r dr,
//
// found on fine elements of degree 1; inside r1 the disc turns as a whole, outside r2 nothing
// moves.
#include <cmath>
#include <complex>
#include <vector>

#include <Eigen/SparseCholesky>

namespace drumhead::oracle {

class RadialReference {
 public:
  RadialReference(double inner, double outer, double angle, double kappa, int elements = 4000)
      : inner_(inner), outer_(outer), angle_(angle), kappa_(kappa), z_(std::size_t(elements) + 1) {
    for (int k = 0; k <= elements; ++k) {
      const double s = double(k) / elements, r = inner + s * (outer - inner);
      // kappa = infinity: |z| = r, and the angle minimises ∫ r³ φ'² dr.
      const double share =
          (1.0 / (r * r) - 1.0 / (outer * outer)) / (1.0 / (inner * inner) - 1.0 / (outer * outer));
      z_[std::size_t(k)] = std::polar(r, angle * share);
    }
    if (std::isfinite(kappa)) minimise();
  }

  /// Deformed position of a point relative to the circles' centre.
  std::complex<double> at(std::complex<double> point) const {
    const double r = std::abs(point);
    if (r >= outer_) return point;
    if (r <= inner_) return point * std::polar(1.0, angle_);
    const double s = (r - inner_) / (outer_ - inner_) * double(z_.size() - 1);
    const std::size_t k = std::min(std::size_t(s), z_.size() - 2);
    const double t = s - double(k);
    return ((1.0 - t) * z_[k] + t * z_[k + 1]) * (point / r);
  }

 private:
  // Energy of one element in its four unknowns by the midpoint rule, with derivatives.
  void element(std::size_t k, double dr, Eigen::Vector4d& g, Eigen::Matrix4d& H) const {
    const double r = inner_ + (double(k) + 0.5) * dr;
    const std::complex<double> z = 0.5 * (z_[k] + z_[k + 1]), d = (z_[k + 1] - z_[k]) / dr;
    Eigen::Matrix4d M;  // (a, b, a', b') from the unknowns
    M << .5, 0, .5, 0, 0, .5, 0, .5, -1 / dr, 0, 1 / dr, 0, 0, -1 / dr, 0, 1 / dr;
    const double c = (z.real() * d.real() + z.imag() * d.imag()) / r - 1.0;
    const Eigen::Vector4d v(z.real(), z.imag(), d.real(), d.imag());
    const Eigen::Vector4d dc = Eigen::Vector4d(d.real(), d.imag(), z.real(), z.imag()) / r;
    const Eigen::Vector4d weight(1 / (r * r), 1 / (r * r), 1.0, 1.0);
    Eigen::Matrix4d second = Eigen::Matrix4d::Zero();
    second(0, 2) = second(2, 0) = second(1, 3) = second(3, 1) = 1.0 / r;
    const Eigen::Vector4d slope = weight.cwiseProduct(v) + kappa_ * c * dc;
    Eigen::Matrix4d curvature = kappa_ * (dc * dc.transpose() + c * second);
    curvature += Eigen::Matrix4d(weight.asDiagonal());
    g = r * dr * M.transpose() * slope;
    H = r * dr * M.transpose() * curvature * M;
  }

  void minimise() {
    const std::size_t elements = z_.size() - 1;
    const double dr = (outer_ - inner_) / double(elements);
    const int unknowns = 2 * (int(elements) - 1);
    for (int step = 0; step < 50; ++step) {
      Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
      std::vector<Eigen::Triplet<double>> entries;
      for (std::size_t k = 0; k < elements; ++k) {
        Eigen::Vector4d g;
        Eigen::Matrix4d H;
        element(k, dr, g, H);
        const int first = 2 * int(k) - 2;
        for (int a = 0; a < 4; ++a) {
          if (first + a < 0 || first + a >= unknowns) continue;
          right[first + a] -= g[a];
          for (int b = 0; b < 4; ++b)
            if (first + b >= 0 && first + b < unknowns)
              entries.push_back({first + a, first + b, H(a, b)});
        }
      }
      Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
      matrix.setFromTriplets(entries.begin(), entries.end());
      const Eigen::VectorXd dz =
          Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
      for (std::size_t k = 1; k < elements; ++k)
        z_[k] += std::complex<double>(dz[2 * Eigen::Index(k) - 2], dz[2 * Eigen::Index(k) - 1]);
      if (dz.lpNorm<Eigen::Infinity>() < 1e-13) break;
    }
  }

  double inner_, outer_, angle_, kappa_;
  std::vector<std::complex<double>> z_;
};

}  // namespace drumhead::oracle
