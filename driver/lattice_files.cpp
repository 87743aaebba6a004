// SPDX-License-Identifier: MIT
#include "lattice_files.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "float_exr.h"
#include "vtk_array.h"

namespace drumhead::driver {
namespace {

using multigrid::Solution;

double pressure(const Solution& s, std::size_t cell) {
  return s.pressure.empty() ? 0.0 : s.pressure[cell];
}

FloatExr lattice_exr(const Solution& s, int columns, int rows, std::vector<std::string> channels) {
  std::ostringstream place;
  place.precision(17);
  place << "node (i, j) rests at (" << s.lattice.origin_px.x << " + i h, " << s.lattice.origin_px.y
        << " + j h), h = " << s.lattice.cell_px << " picture pixels, x right, y down";
  const Frame all{0, 0, columns, rows};
  return {all, all, std::move(channels), {{"drumhead:lattice", place.str()}}};
}

void write_nodes(const Solution& s, std::ostream& stream) {
  const auto add_vectors = [&](const char* name, const auto& vector) {
    VtkArray<double> array(stream, name, 3, 3 * s.lattice.nodes());
    std::size_t k = 0;
    for (int j = 0; j <= s.lattice.ny; ++j) {
      for (int i = 0; i <= s.lattice.nx; ++i, ++k) {
        const grid::Point p = vector(i, j, grid::Point{s.u_px[k], s.v_px[k]});
        array.add(p.x), array.add(p.y), array.add(0.0);
      }
    }
  };
  stream << "<PointData Vectors=\"displacement\">\n";
  add_vectors("displacement", [](int, int, grid::Point u) { return u; });
  stream << "</PointData>\n<Points>\n";
  add_vectors("xhat", [&](int i, int j, grid::Point u) { return s.lattice.rest_px(i, j) + u; });
  stream << "</Points>\n";
}

void write_cells(const Solution& s, std::ostream& stream) {
  const auto add_scalars = [&](const char* name, const auto& scalar) {
    VtkArray<double> array(stream, name, 1, s.lattice.cells());
    for (int j = 0; j < s.lattice.ny; ++j) {
      for (int i = 0; i < s.lattice.nx; ++i) array.add(scalar(i, j));
    }
  };
  stream << "<CellData Scalars=\"J\">\n";
  add_scalars("P", [&](int i, int j) {
    return pressure(s, std::size_t(j) * std::size_t(s.lattice.nx) + std::size_t(i));
  });
  add_scalars("J", [&](int i, int j) { return multigrid::cell_J(s, i, j).centre; });
  add_scalars("corner_J", [&](int i, int j) { return multigrid::cell_J(s, i, j).least_corner; });
  stream << "</CellData>\n";
}

}  // namespace

void write_lattice(const Solution& s, const std::filesystem::path& file) {
  const int columns = s.lattice.nx + 1;
  FloatExr exr = lattice_exr(s, columns, s.lattice.ny + 1, {"u", "v"});
  std::ostringstream error;  // std::to_string leaves nothing of 1e-7
  error << s.report.discretisation_rms_px;
  exr.header.emplace_back(kLatticeError, error.str());
  exr.header.emplace_back(kLatticeCurves, multigrid::name(s.report.curve_method));
  write_float_exr(exr, file, [&](int first, int rows, float* pixels) {
    std::size_t k = std::size_t(first) * std::size_t(columns);
    const std::size_t end = k + std::size_t(rows) * std::size_t(columns);
    for (; k < end; ++k) {
      *pixels++ = float(s.u_px[k]);
      *pixels++ = float(s.v_px[k]);
    }
  });
}

void write_lattice_cells(const Solution& s, const std::filesystem::path& file) {
  const int nx = s.lattice.nx;
  write_float_exr(lattice_exr(s, nx, s.lattice.ny, {"P", "J", "corner_J"}), file,
                  [&](int first, int rows, float* pixels) {
                    std::size_t k = std::size_t(first) * std::size_t(nx);
                    for (int j = first; j < first + rows; ++j) {
                      for (int i = 0; i < nx; ++i) {
                        const multigrid::CellJ J = multigrid::cell_J(s, i, j);
                        *pixels++ = float(pressure(s, k++));
                        *pixels++ = float(J.centre);
                        *pixels++ = float(J.least_corner);
                      }
                    }
                  });
}

void write_lattice_vtk(const Solution& s, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  std::ostringstream extent;
  extent << "\"0 " << s.lattice.nx << " 0 " << s.lattice.ny << " 0 0\"";
  begin_vtk(stream, "StructuredGrid");
  stream << "<StructuredGrid WholeExtent=" << extent.str() << ">\n<Piece Extent=" << extent.str()
         << ">\n";
  write_nodes(s, stream);
  write_cells(s, stream);
  stream << "</Piece>\n</StructuredGrid>\n</VTKFile>\n" << std::flush;
  if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace drumhead::driver
