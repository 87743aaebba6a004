// SPDX-License-Identifier: MIT
// The lattice as files: EXR of nodes and cells, VTK's XML as its file format specification has it.
#include "lattice_files.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <pugixml.hpp>

#include "driver_scratch.h"
#include "image.h"

namespace drumhead::driver {
namespace {

/// 2 × 1 cells of 10 px; the middle bottom node moves by (−4, 2), and the left cell is squeezed.
multigrid::Solution two_cells() {
  multigrid::Solution s;
  s.lattice = {.nx = 2, .ny = 1, .cell_px = 10.0, .origin_px = {-5.0, -3.0}};
  s.u_px = {0, 0, 0, 0, -4, 0};
  s.v_px = {0, 0, 0, 0, 2, 0};
  s.pressure = {-0.25, 0.5};
  return s;
}
// Of its left cell: edges (10,0), (0,10), and (6,2) below; J at the corners 1, (10·12)/100,
// (6·10)/100,
// ((6·12) − (2·−4))/100; the mean of all four is J at the centre.
constexpr double kLeftJ = (1.0 + 1.2 + 0.6 + 0.8) / 4, kLeftCornerJ = 0.6;

class DriverLattice : public testing::Test {
 protected:
  Scratch scratch;
};

TEST_F(DriverLattice, ExrHasOnePixelANode) {
  write_lattice(two_cells(), scratch / "l.exr");
  const Image image = read_image(scratch / "l.exr");
  EXPECT_EQ(image.spec.channelnames, (std::vector<std::string>{"u", "v"}));
  ASSERT_EQ((std::array{image.width(), image.height()}), (std::array{3, 2}));
  EXPECT_EQ(image.pixels, (std::vector<float>{0, 0, 0, 0, 0, 0, 0, 0, -4, 2, 0, 0}));
  const std::string text(image.spec.get_string_attribute("drumhead:lattice"));
  EXPECT_NE(text.find("(-5 + i h, -3 + j h), h = 10"), std::string::npos) << text;
}

TEST_F(DriverLattice, ExrOfCellsHasPressureAndJ) {
  write_lattice_cells(two_cells(), scratch / "c.exr");
  const Image image = read_image(scratch / "c.exr");
  ASSERT_EQ((std::array{image.width(), image.height()}), (std::array{2, 1}));
  const auto value = [&](int i, const std::string& channel) {
    return image.pixels[std::size_t(i * 3 + image.spec.channelindex(channel))];
  };
  EXPECT_EQ(value(0, "P"), -0.25f);
  EXPECT_EQ(value(1, "P"), 0.5f);
  EXPECT_FLOAT_EQ(value(0, "J"), float(kLeftJ));
  EXPECT_FLOAT_EQ(value(0, "corner_J"), float(kLeftCornerJ));
}

TEST_F(DriverLattice, WithoutPressuresTheyAreZero) {
  multigrid::Solution s = two_cells();
  s.pressure.clear();
  write_lattice_cells(s, scratch / "c.exr");
  const Image image = read_image(scratch / "c.exr");
  EXPECT_EQ(image.pixels[std::size_t(image.spec.channelindex("P"))], 0.0f);
}

/// As RFC 4648 has it.
std::vector<unsigned char> decoded(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::size_t value = letters.find(c);
    if (value == std::string::npos) throw std::runtime_error("not base64: " + std::string(1, c));
    bits = bits << 6 | std::uint32_t(value);
    if ((count += 6) >= 8) bytes.push_back(static_cast<unsigned char>(bits >> (count -= 8)));
  }
  return bytes;
}

/// A <DataArray> of format "binary", header_type "UInt64".
template <class T = double>
std::vector<T> values_of(const pugi::xml_node& array) {
  const std::string text = array.child_value();
  EXPECT_EQ(text.size() % 4, 0u);
  const auto bytes = decoded(text);
  std::uint64_t size = 0;
  if (bytes.size() < sizeof size) throw std::runtime_error("an array without its size");
  std::memcpy(&size, bytes.data(), sizeof size);
  EXPECT_EQ(bytes.size(), sizeof size + size);
  std::vector<T> values(size / sizeof(T));
  std::memcpy(values.data(), bytes.data() + sizeof size, values.size() * sizeof(T));
  return values;
}

struct VtkGrid {
  std::array<int, 6> extent{};
  std::map<std::string, std::vector<double>> points, cells;  // by array; "" the points themselves
};

/// Reads a StructuredGrid of one piece, and checks what VTK's reader relies on.
VtkGrid read_vts(const std::filesystem::path& file) {
  pugi::xml_document document;
  const auto parsed = document.load_file(file.c_str());
  EXPECT_TRUE(parsed) << parsed.description();
  const pugi::xml_node top = document.child("VTKFile");
  EXPECT_STREQ(top.attribute("type").value(), "StructuredGrid");
  EXPECT_STREQ(top.attribute("version").value(), "1.0");
  EXPECT_STREQ(top.attribute("byte_order").value(), "LittleEndian");
  EXPECT_STREQ(top.attribute("header_type").value(), "UInt64");
  const pugi::xml_node grid = top.child("StructuredGrid"), piece = grid.child("Piece");
  EXPECT_STREQ(grid.attribute("WholeExtent").value(), piece.attribute("Extent").value());
  EXPECT_FALSE(piece.next_sibling("Piece"));
  VtkGrid result;
  std::istringstream extent(piece.attribute("Extent").value());
  for (int& bound : result.extent) extent >> bound;
  EXPECT_TRUE(extent);
  const auto nodes = std::size_t(result.extent[1] + 1) * std::size_t(result.extent[3] + 1);
  const auto cells = std::size_t(result.extent[1]) * std::size_t(result.extent[3]);
  const auto read = [&](const pugi::xml_node& section, std::size_t tuples, auto& into) {
    for (const pugi::xml_node& array : section.children("DataArray")) {
      EXPECT_STREQ(array.attribute("type").value(), "Float64");
      EXPECT_STREQ(array.attribute("format").value(), "binary");
      auto values = values_of(array);
      EXPECT_EQ(values.size(), tuples * array.attribute("NumberOfComponents").as_uint());
      into[array.attribute("Name").value()] = std::move(values);
    }
  };
  EXPECT_EQ(piece.child("Points").select_nodes("DataArray").size(), 1u);
  read(piece.child("Points"), nodes, result.points);
  read(piece.child("PointData"), nodes, result.points);
  read(piece.child("CellData"), cells, result.cells);
  return result;
}

TEST_F(DriverLattice, VtkHasDeformedPointsAndTheirDisplacement) {
  write_lattice_vtk(two_cells(), scratch / "l.vts");
  VtkGrid grid = read_vts(scratch / "l.vts");
  EXPECT_EQ(grid.extent, (std::array{0, 2, 0, 1, 0, 0}));
  EXPECT_EQ(grid.points["xhat"], (std::vector<double>{-5, -3, 0, 5, -3, 0, 15, -3, 0,  //
                                                      -5, 7, 0, 1, 9, 0, 15, 7, 0}));
  EXPECT_EQ(grid.points["displacement"],
            (std::vector<double>{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -4, 2, 0, 0, 0, 0}));
}

TEST_F(DriverLattice, VtkHasPressureAndJOfEveryCell) {
  write_lattice_vtk(two_cells(), scratch / "l.vts");
  VtkGrid grid = read_vts(scratch / "l.vts");
  EXPECT_EQ(grid.cells["P"], (std::vector<double>{-0.25, 0.5}));
  ASSERT_EQ(grid.cells["J"].size(), 2u);
  EXPECT_DOUBLE_EQ(grid.cells["J"][0], kLeftJ);
  EXPECT_DOUBLE_EQ(grid.cells["corner_J"][0], kLeftCornerJ);
}

// Arrays are encoded in pieces of 24 KiB: one that is much longer, in every remainder by three.
TEST_F(DriverLattice, VtkArraysOfAnyLengthAreWhole) {
  for (const int nx : {97, 98, 99}) {
    multigrid::Solution s;
    s.lattice = {.nx = nx, .ny = 60};
    for (std::size_t k = 0; k < s.lattice.nodes(); ++k) {
      s.u_px.push_back(1e-3 * double(k));
      s.v_px.push_back(-double(k));
    }
    s.pressure.assign(s.lattice.cells(), 1.0 / 3.0);
    write_lattice_vtk(s, scratch / "l.vts");
    VtkGrid grid = read_vts(scratch / "l.vts");
    ASSERT_EQ(grid.points["displacement"].size(), 3 * s.lattice.nodes());
    for (std::size_t k = 0; k < s.lattice.nodes(); ++k) {
      ASSERT_EQ(grid.points["displacement"][3 * k], s.u_px[k]);
      ASSERT_EQ(grid.points["displacement"][3 * k + 1], s.v_px[k]);
    }
    EXPECT_EQ(grid.cells["P"], s.pressure);
  }
}

/// Three cells in a row, the middle one divided along its diagonal, whose upper node moved with it.
multigrid::Solution split_cell() {
  multigrid::Solution s;
  s.lattice = {.nx = 3, .ny = 1, .cell_px = 10.0};
  s.u_px.assign(8, 0.0);
  s.v_px.assign(8, 0.0);
  s.u_px[5] = 2.0;  // the node at (10, 10)
  s.pressure = {1, 2, 3};
  s.split.row_begin = {0, 1};
  s.split.column = {1};
  s.split.triangle_begin = {0, 2};
  s.split.triangle = {{{{10, 0}, {20, 0}, {20, 10}}, {{0, 0}, {0, 0}, {0, 0}}},
                      {{{10, 0}, {20, 10}, {10, 10}}, {{0, 0}, {0, 0}, {2, 0}}}};
  s.split.pressure = {-1, 5};
  return s;
}

TEST_F(DriverLattice, VtuHasTheTrianglesOfDividedCellsAndTheQuadsOfOthers) {
  write_lattice_vtu(split_cell(), scratch / "l.vtu");
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file((scratch / "l.vtu").c_str()));
  const pugi::xml_node top = document.child("VTKFile");
  EXPECT_STREQ(top.attribute("type").value(), "UnstructuredGrid");
  const pugi::xml_node piece = top.child("UnstructuredGrid").child("Piece");
  EXPECT_EQ(piece.attribute("NumberOfPoints").as_int(), 8);  // none twice
  EXPECT_EQ(piece.attribute("NumberOfCells").as_int(), 4);
  const auto array = [&](const char* section, const char* name) {
    return piece.child(section).find_child_by_attribute("DataArray", "Name", name);
  };
  const auto doubles = [&](const char* section, const char* name) {
    return values_of<double>(array(section, name));
  };
  EXPECT_STREQ(array("Cells", "types").attribute("type").value(), "UInt8");
  EXPECT_STREQ(array("Cells", "offsets").attribute("type").value(), "Int64");
  EXPECT_EQ(values_of<std::uint8_t>(array("Cells", "types")),
            (std::vector<std::uint8_t>{9, 5, 5, 9}));
  EXPECT_EQ(values_of<std::int64_t>(array("Cells", "offsets")),
            (std::vector<std::int64_t>{4, 7, 10, 14}));
  EXPECT_EQ(doubles("CellData", "P"), (std::vector<double>{1, -1, 5, 3}));
  EXPECT_EQ(doubles("CellData", "J"), (std::vector<double>{1.1, 1, 0.8, 1}));
  // Every cell's corners, deformed.
  const auto nodes = values_of<std::int64_t>(array("Cells", "connectivity"));
  const auto xhat = doubles("Points", "xhat"), moved = doubles("PointData", "displacement");
  ASSERT_EQ(nodes.size(), 14u);
  std::vector<double> x, y;
  for (const std::int64_t n : nodes) {
    x.push_back(xhat[std::size_t(3 * n)]);
    y.push_back(xhat[std::size_t(3 * n + 1)]);
    EXPECT_EQ(moved[std::size_t(3 * n)], x.back() == 12.0 ? 2.0 : 0.0);
  }
  EXPECT_EQ(x, (std::vector<double>{0, 10, 12, 0, 10, 20, 20, 10, 20, 12, 20, 30, 30, 20}));
  EXPECT_EQ(y, (std::vector<double>{0, 0, 10, 10, 0, 0, 10, 0, 10, 10, 0, 0, 10, 10}));
}

TEST_F(DriverLattice, AFileThatCannotBeWrittenIsNamed) {
  EXPECT_NE(message_of([&] {
              write_lattice_vtk(two_cells(), scratch / "no/l.vts");
            }).find("no/l.vts: cannot be written"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              write_lattice_vtu(two_cells(), scratch / "no/l.vtu");
            }).find("no/l.vtu: cannot be written"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              write_lattice(two_cells(), scratch / "no/l.exr");
            }).find("no/l.exr: cannot be written"),
            std::string::npos);
}

}  // namespace
}  // namespace drumhead::driver
