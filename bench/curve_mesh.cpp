// SPDX-License-Identifier: MIT
#include "curve_mesh.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/LU>

namespace drumhead::bench {
namespace {

using Eigen::Vector2d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
// The numbers of vertices and triangles in CurveMesh.
using VertexInfo = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using Vertex = CGAL::Delaunay_mesh_vertex_base_2<Kernel, VertexInfo>;
using FaceInfo =
    CGAL::Triangulation_face_base_with_info_2<int, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Face = CGAL::Delaunay_mesh_face_base_2<Kernel, FaceInfo>;
using Delaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel,
                                               CGAL::Triangulation_data_structure_2<Vertex, Face>>;
using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Delaunay>;

// CGAL bounds the longest edge. With this bound in cells the mesh has (n + 1)² vertices to 5 %, and
// the curves are given in pieces of about the mean edge.
constexpr double kLongestEdge = 1.58, kPiece = 1.1;
constexpr double kShape = 0.125;  // the sine squared of the least angle

Kernel::Point_2 point(const Vector2d& p) { return {p.x(), p.y()}; }

scenes::Polyline in_pieces(const scenes::Polyline& curve, double piece) {
  std::vector<double> length{0.0};
  for (std::size_t k = 1; k < curve.source.size(); ++k)
    length.push_back(length.back() + (curve.source[k] - curve.source[k - 1]).norm());
  const int count = std::max(1, int(std::lround(length.back() / piece)));
  scenes::Polyline result;
  for (int k = 0; k <= count; ++k) {
    const double at = length.back() * k / count;
    const auto next = std::lower_bound(length.begin() + 1, length.end() - 1, at);
    const std::size_t b = std::size_t(next - length.begin()), a = b - 1;
    const double share = std::clamp((at - length[a]) / (length[b] - length[a]), 0.0, 1.0);
    result.source.push_back((1.0 - share) * curve.source[a] + share * curve.source[b]);
    result.target.push_back((1.0 - share) * curve.target[a] + share * curve.target[b]);
  }
  return result;
}

void insert(Delaunay& mesh, const scenes::Polyline& pieces) {
  for (std::size_t k = 1; k < pieces.source.size(); ++k)
    mesh.insert_constraint(point(pieces.source[k - 1]), point(pieces.source[k]));
}

/// Where a point on one of the curves goes: as the nearest piece says.
Vector2d carried(const Vector2d& p, const std::vector<scenes::Polyline>& curves) {
  double nearest = std::numeric_limits<double>::infinity();
  Vector2d to = p;
  for (const scenes::Polyline& curve : curves)
    for (std::size_t k = 1; k < curve.source.size(); ++k) {
      const Vector2d a = curve.source[k - 1], chord = curve.source[k] - a;
      const double share = std::clamp((p - a).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
      const double distance = (p - a - share * chord).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      to = (1.0 - share) * curve.target[k - 1] + share * curve.target[k];
    }
  return to;
}

/// Corners that share a vertex across an edge that is no curve belong together.
void find_patches(const Delaunay& mesh, CurveMesh& result) {
  std::vector<int> leader(3 * result.triangles.size());
  std::iota(leader.begin(), leader.end(), 0);
  const auto first = [&](int k) {
    while (leader[std::size_t(k)] != k)
      k = leader[std::size_t(k)] = leader[std::size_t(leader[std::size_t(k)])];
    return k;
  };
  for (auto edge = mesh.finite_edges_begin(); edge != mesh.finite_edges_end(); ++edge) {
    const auto face = edge->first, other = face->neighbor(edge->second);
    if (mesh.is_constrained(*edge) || mesh.is_infinite(face) || mesh.is_infinite(other)) continue;
    for (const int corner : {Delaunay::ccw(edge->second), Delaunay::cw(edge->second)}) {
      const int there = other->index(face->vertex(corner));
      leader[std::size_t(first(3 * face->info() + corner))] = first(3 * other->info() + there);
    }
  }
  std::vector<int> number(leader.size(), -1);
  for (std::size_t t = 0; t < result.triangles.size(); ++t) {
    std::array<int, 3> patch;
    for (int k = 0; k < 3; ++k) {
      int& at = number[std::size_t(first(3 * int(t) + k))];
      if (at < 0) at = result.patches++;
      patch[std::size_t(k)] = at;
    }
    result.patch.push_back(patch);
  }
}

}  // namespace

struct CurveMesh::Triangulation {
  Delaunay mesh;
};

CurveMesh mesh_along_curves(const scenes::Scene& scene, int n) {
  const auto triangulation = std::make_shared<CurveMesh::Triangulation>();
  Delaunay& mesh = triangulation->mesh;
  std::vector<scenes::Polyline> curves;
  for (const scenes::Polyline& curve : scene.curves) curves.push_back(in_pieces(curve, kPiece / n));
  const std::vector<Vector2d> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  insert(mesh, in_pieces({"edge", square, square}, kPiece / n));
  for (const scenes::Polyline& curve : curves) insert(mesh, curve);
  CGAL::refine_Delaunay_mesh_2(mesh, Criteria(kShape, kLongestEdge / n));

  CurveMesh result;
  for (const auto vertex : mesh.finite_vertex_handles()) {
    vertex->info() = int(result.rest.size());
    result.rest.emplace_back(vertex->point().x(), vertex->point().y());
  }
  for (const auto face : mesh.finite_face_handles()) {
    face->info() = int(result.triangles.size());
    result.triangles.push_back(
        {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  }
  result.known.assign(result.rest.size(), 0);
  result.target = result.rest;
  for (const auto& edge : mesh.constrained_edges())
    for (const int corner : {Delaunay::ccw(edge.second), Delaunay::cw(edge.second)}) {
      const auto v = std::size_t(edge.first->vertex(corner)->info());
      if (std::exchange(result.known[v], 1)) continue;
      const Vector2d& p = result.rest[v];
      if (p.minCoeff() > 0.0 && p.maxCoeff() < 1.0) result.target[v] = carried(p, curves);
    }
  find_patches(mesh, result);
  result.triangulation = triangulation;
  return result;
}

std::vector<CurveMesh::Place> CurveMesh::places_of(const std::vector<Vector2d>& points) const {
  const Delaunay& mesh = triangulation->mesh;
  std::vector<Place> result;
  Delaunay::Face_handle face;
  for (const Vector2d& p : points) {
    face = mesh.locate(point(p), face);
    // On the square's edge the triangle beyond it may be found.
    if (mesh.is_infinite(face)) face = face->neighbor(face->index(mesh.infinite_vertex()));
    Place place{.triangle = face->info()};
    const auto& corners = triangles[std::size_t(place.triangle)];
    const Vector2d a = rest[std::size_t(corners[0])];
    Eigen::Matrix2d sides;
    sides << rest[std::size_t(corners[1])] - a, rest[std::size_t(corners[2])] - a;
    const Vector2d share = sides.inverse() * (p - a);
    place.share = {1.0 - share.sum(), share.x(), share.y()};
    result.push_back(place);
  }
  return result;
}

}  // namespace drumhead::bench
