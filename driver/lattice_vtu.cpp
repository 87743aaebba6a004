// SPDX-License-Identifier: MIT
#include <array>
#include <fstream>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "lattice_files.h"
#include "vtk_array.h"

namespace drumhead::driver {
namespace {

using multigrid::Solution;

// Cell types of VTK.
constexpr std::uint8_t kTriangle = 5, kQuad = 9;

/// The deformed mesh: cells of the lattice as quads, those that curves divide as their triangles,
/// which share the nodes that they have in common.
class Mesh {
 public:
  explicit Mesh(const Solution& solution)
      : solution_(solution), number_(solution.lattice.nodes(), -1) {
    const grid::Lattice& lattice = solution.lattice;
    const kernels::SplitCellsView split = solution.split.view();
    for (int j = 0; j < lattice.ny; ++j)
      for (int i = 0; i < lattice.nx; ++i) {
        const int c = split.find(i, j);
        if (c < 0) {
          add_quad(i, j);
          continue;
        }
        for (int t = split.triangle_begin[c]; t < split.triangle_begin[c + 1]; ++t)
          add_triangle(i, j, std::size_t(t));
      }
  }

  void write(std::ostream& stream) const {
    stream << "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" << rest_.size()
           << "\" NumberOfCells=\"" << type_.size()
           << "\">\n<PointData Vectors=\"displacement\">\n";
    write_points(stream, "displacement", false);
    stream << "</PointData>\n<CellData Scalars=\"J\">\n";
    const std::array names{"P", "J", "corner_J"};
    for (std::size_t n = 0; n < names.size(); ++n) write_array(stream, names[n], value_[n]);
    stream << "</CellData>\n<Points>\n";
    write_points(stream, "xhat", true);
    stream << "</Points>\n<Cells>\n";
    write_array(stream, "connectivity", connectivity_);
    write_array(stream, "offsets", end_);
    write_array(stream, "types", type_);
    stream << "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  }

 private:
  std::size_t node(int i, int j) const {
    return std::size_t(j) * std::size_t(solution_.lattice.nx + 1) + std::size_t(i);
  }
  std::int64_t add_point(grid::Point rest, grid::Point displacement) {
    rest_.push_back(rest);
    displacement_.push_back(displacement);
    return std::int64_t(rest_.size()) - 1;
  }
  std::int64_t lattice_point(int i, int j) {
    const std::size_t n = node(i, j);
    if (number_[n] < 0) {
      const grid::Point rest = solution_.lattice.rest_px(i, j);
      number_[n] = point_at(rest, {solution_.u_px[n], solution_.v_px[n]});
    }
    return number_[n];
  }
  /// Triangles and quads have a common node at exactly the same place.
  std::int64_t point_at(grid::Point rest, grid::Point displacement) {
    const auto [at, added] = point_.try_emplace({rest.y, rest.x}, 0);
    if (added) at->second = add_point(rest, displacement);
    return at->second;
  }
  void add_cell(std::uint8_t type, std::array<double, 3> values) {
    type_.push_back(type);
    end_.push_back(std::int64_t(connectivity_.size()));
    for (std::size_t n = 0; n < 3; ++n) value_[n].push_back(values[n]);
  }
  double pressure(int i, int j) const {
    if (solution_.pressure.empty()) return 0.0;
    return solution_.pressure[std::size_t(j) * std::size_t(solution_.lattice.nx) + std::size_t(i)];
  }
  void add_quad(int i, int j) {
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
      connectivity_.push_back(lattice_point(i + x, j + y));
    const multigrid::CellJ J = multigrid::cell_J(solution_, i, j);
    add_cell(kQuad, {pressure(i, j), J.centre, J.least_corner});
  }
  void add_triangle(int i, int j, std::size_t t) {
    const kernels::MapTriangle& triangle = solution_.split.triangle[t];
    for (std::size_t k = 0; k < 3; ++k)
      connectivity_.push_back(point_at({triangle.rest[k].x, triangle.rest[k].y},
                                       {triangle.displacement[k].x, triangle.displacement[k].y}));
    const double J = multigrid::triangle_J(triangle);
    const std::vector<double>& pressures = solution_.split.pressure;
    add_cell(kTriangle, {pressures.empty() ? pressure(i, j) : pressures[t], J, J});
  }

  void write_points(std::ostream& stream, const char* name, bool deformed) const {
    VtkArray<double> array(stream, name, 3, 3 * rest_.size());
    for (std::size_t n = 0; n < rest_.size(); ++n) {
      const grid::Point p = deformed ? rest_[n] + displacement_[n] : displacement_[n];
      array.add(p.x), array.add(p.y), array.add(0.0);
    }
  }
  template <class T>
  static void write_array(std::ostream& stream, const char* name, const std::vector<T>& values) {
    VtkArray<T> array(stream, name, 1, values.size());
    for (const T value : values) array.add(value);
  }

  const Solution& solution_;
  std::vector<std::int64_t> number_;  // of lattice nodes, −1: not a point yet
  std::map<std::pair<double, double>, std::int64_t> point_;  // by rest y, x
  std::vector<grid::Point> rest_, displacement_;
  std::vector<std::int64_t> connectivity_, end_;
  std::vector<std::uint8_t> type_;
  std::array<std::vector<double>, 3> value_;  // P, J, corner_J
};

}  // namespace

void write_lattice_vtu(const Solution& s, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  begin_vtk(stream, "UnstructuredGrid");
  Mesh(s).write(stream);
  stream << std::flush;
  if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace drumhead::driver
