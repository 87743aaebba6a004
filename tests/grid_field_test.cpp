// SPDX-License-Identifier: MIT
// Fields that own their memory.
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <drumhead/grid/field.h>

namespace drumhead::grid {
namespace {

template <class T>
class GridField : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(GridField, Numbers);

TYPED_TEST(GridField, BothHalvesOfEveryRowAreAligned) {
  MemoryMeter meter;
  for (const int columns : {1, 2, 15, 16, 17, 33, 129}) {
    Field<TypeParam> field(columns, 3, meter);
    for (int j = 0; j < 3; ++j)
      for (const int parity : {0, 1}) {
        const auto address = reinterpret_cast<std::uintptr_t>(field.view().half(j, parity));
        EXPECT_EQ(address % 64, 0u) << columns << " columns, row " << j;
      }
  }
}

TYPED_TEST(GridField, HalvesAndRowsDoNotOverlap) {
  MemoryMeter meter;
  for (const int columns : {1, 2, 15, 16, 17, 33, 129}) {
    Field<TypeParam> field(columns, 3, meter);
    const auto view = field.view();
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < columns; ++i) view.at(i, j) = TypeParam(j * columns + i);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < columns; ++i) ASSERT_EQ(view.at(i, j), TypeParam(j * columns + i));
  }
}

TYPED_TEST(GridField, BeginsAtZeroWithoutAMeterToo) {
  const Field<TypeParam> field(9, 4);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 9; ++i) EXPECT_EQ(field.view().at(i, j), TypeParam(0));
}

TYPED_TEST(GridField, ClearsToZero) {
  MemoryMeter meter;
  Field<TypeParam> field(9, 4, meter);
  field.view().at(3, 2) = TypeParam(5);
  field.clear();
  EXPECT_EQ(field.view().at(3, 2), TypeParam(0));
}

TYPED_TEST(GridField, HasTheColumnsAndRowsAskedFor) {
  MemoryMeter meter;
  const Field<TypeParam> field(9, 4, meter);
  EXPECT_EQ(field.view().columns, 9);
  EXPECT_EQ(field.view().rows, 4);
}

TYPED_TEST(GridField, AnEmptyOneHasANullView) {
  const Field<TypeParam> field;
  EXPECT_FALSE(field);
  EXPECT_FALSE(field.view());
  EXPECT_EQ(field.bytes(), 0u);
}

TYPED_TEST(GridField, MeterCountsBytesInUseAndTheirPeak) {
  MemoryMeter meter;
  {
    const Field<TypeParam> first(100, 10, meter);
    EXPECT_EQ(meter.current(), first.bytes());
    EXPECT_GE(first.bytes(), 100 * 10 * sizeof(TypeParam));
    const Field<TypeParam> second(50, 10, meter);
    EXPECT_EQ(meter.current(), first.bytes() + second.bytes());
  }
  EXPECT_EQ(meter.current(), 0u);
  const std::size_t peak = meter.peak();
  EXPECT_GE(peak, 150 * 10 * sizeof(TypeParam));
  const Field<TypeParam> third(10, 10, meter);
  EXPECT_EQ(meter.peak(), peak);
}

TYPED_TEST(GridField, WastesLessThanTwoLinesARow) {
  MemoryMeter meter;
  for (const int columns : {1, 64, 801}) {
    const Field<TypeParam> field(columns, 7, meter);
    EXPECT_LE(field.bytes(), 7 * (std::size_t(columns) * sizeof(TypeParam) + 2 * 64));
  }
}

TYPED_TEST(GridField, MovingKeepsTheValuesAndTheirPlace) {
  MemoryMeter meter;
  Field<TypeParam> from(5, 5, meter);
  from.view().at(2, 2) = TypeParam(7);
  const TypeParam* place = &from.view().at(2, 2);
  Field<TypeParam> to(std::move(from));
  EXPECT_EQ(&to.view().at(2, 2), place);
  EXPECT_EQ(*place, TypeParam(7));
  EXPECT_EQ(meter.current(), to.bytes());
}

TYPED_TEST(GridField, MovingOntoAnotherReleasesItsMemory) {
  MemoryMeter meter;
  Field<TypeParam> target(50, 50, meter), source(5, 5, meter);
  target = std::move(source);
  EXPECT_EQ(target.view().columns, 5);
  EXPECT_EQ(meter.current(), target.bytes());
  target = Field<TypeParam>();
  EXPECT_EQ(meter.current(), 0u);
}

TYPED_TEST(GridField, ReservedOnesFollowOneAnotherWhileTheyFit) {
  MemoryMeter meter;
  const std::size_t bytes = Field<TypeParam>::bytes(9, 4);
  meter.reserve(2 * bytes + 64);
  const Field<TypeParam> first(9, 4, meter), second(9, 4, meter), own(9, 4, meter);
  EXPECT_EQ(first.bytes(), bytes);
  EXPECT_EQ(second.view().data, first.view().data + bytes / sizeof(TypeParam));
  EXPECT_NE(own.view().data, second.view().data + bytes / sizeof(TypeParam));
  EXPECT_EQ(meter.current(), 3 * bytes);
}

TYPED_TEST(GridField, LargeOnesBeginAtZeroEverywhereToo) {
  MemoryMeter meter;
  meter.reserve(3 * Field<TypeParam>::bytes(801, 700));  // 6.3 MiB and more: from the system
  for (int n = 0; n < 4; ++n) {                          // the last one apart
    Field<TypeParam> field(801, 700, meter);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(field.view().data) % 64, 0u);
    std::size_t wrong = 0;
    for (int j = 0; j < 700; ++j)
      for (int i = 0; i < 801; ++i) {
        wrong += field.view().at(i, j) != TypeParam(0);
        field.view().at(i, j) = TypeParam(1);
      }
    EXPECT_EQ(wrong, 0u) << "field " << n;
  }
  EXPECT_EQ(meter.current(), 0u);
}

TYPED_TEST(GridField, HugePagesForOtherArraysChangeNoValue) {
  std::vector<TypeParam> values(2000000, TypeParam(3));
  for (const std::size_t begin : {0, 1, 1000}) {
    prefer_huge_pages(values.data() + begin, 0);
    prefer_huge_pages(values.data() + begin, 100 * sizeof(TypeParam));
    prefer_huge_pages(values.data() + begin, (values.size() - begin) * sizeof(TypeParam));
  }
  for (const TypeParam value : values) ASSERT_EQ(value, TypeParam(3));
}

TYPED_TEST(GridField, UnknownsHaveNodesAndCellsOfTheirLattice) {
  MemoryMeter meter;
  UnknownFields<TypeParam> fields(7, 4, true, meter);
  EXPECT_EQ(fields.view().x.columns, 8);
  EXPECT_EQ(fields.view().y.rows, 5);
  EXPECT_EQ(fields.view().p.columns, 7);
  EXPECT_EQ(fields.view().p.rows, 4);
}

TYPED_TEST(GridField, UnknownsWithoutPressuresStoreNone) {
  MemoryMeter meter;
  UnknownFields<TypeParam> fields(7, 4, false, meter);
  EXPECT_FALSE(fields.view().p);
  EXPECT_EQ(meter.current(), fields.x.bytes() + fields.y.bytes());
}

}  // namespace
}  // namespace drumhead::grid
