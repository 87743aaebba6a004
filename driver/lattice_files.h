// SPDX-License-Identifier: MIT
#pragma once
// The solution on its lattice: node (i, j) and cell (i, j), i to the right, j down, first row the
// top. Positions in continuous picture pixels, y down. P in units of mu (0 where the membrane has
// no pressure), J the cell's change of area (at its centre, which is its mean), corner_J the least
// of its four corners.
#include <drumhead/multigrid/warp.h>

#include <filesystem>

namespace drumhead::driver {

/// The header attribute of write_lattice that holds the estimated discretisation error, RMS in px.
inline constexpr const char* kLatticeError = "drumhead:discretisation_rms_px";

/// The one that names the way its curves were met.
inline constexpr const char* kLatticeCurves = "drumhead:curve_method";

/// Float32 EXR of (nx+1) × (ny+1) pixels, one a node: channels u, v, displacement in picture
/// pixels. Throws std::runtime_error naming `file`, as the others.
void write_lattice(const multigrid::Solution& solution, const std::filesystem::path& file);

/// Float32 EXR of nx × ny pixels, one a cell: channels P, J, corner_J.
void write_lattice_cells(const multigrid::Solution& solution, const std::filesystem::path& file);

/// VTK XML StructuredGrid (.vts) of doubles: points the deformed nodes x̂ with z = 0, `displacement`
/// at the points, P, J and corner_J in the cells. Of cells that curves divide it has the four
/// corners alone.
void write_lattice_vtk(const multigrid::Solution& solution, const std::filesystem::path& file);

/// VTK XML UnstructuredGrid (.vtu) with the same arrays: undivided cells as quads, the others as
/// their triangles, each with its own P and J.
void write_lattice_vtu(const multigrid::Solution& solution, const std::filesystem::path& file);

}  // namespace drumhead::driver
