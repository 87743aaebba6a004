// SPDX-License-Identifier: MIT
#include "scene_levels.h"

#include <cassert>
#include <type_traits>
#include <utility>

namespace drumhead::multigrid {
namespace {

/// Whether cuts differ in what is wanted at most.
bool same_cells(const grid::CutCells& a, const grid::CutCells& b) {
  return a.row_begin == b.row_begin && a.column == b.column && a.weight == b.weight &&
         a.length == b.length && a.compliance == b.compliance && a.link_begin == b.link_begin &&
         a.link == b.link;
}

}  // namespace

template <class T>
void SceneLevels<T>::build(grid::CutCells cuts) {
  hierarchy_.reset();
  meter_ = {};
  cuts_ = std::move(cuts);
  hierarchy_ =
      std::make_unique<Hierarchy<T>>(key_.lattice, key_.material, cuts_, key_.traits, meter_);
}

template <class T>
void SceneLevels<T>::lay_out(const std::vector<grid::CurvePair>& curves) {
  if (key_.conforming) {
    build(grid::cut({}, key_.lattice, key_.most_weight));
    hierarchy_->conform(curves, key_.lattice, meter_);
  } else {
    build(grid::cut(curves, key_.lattice, key_.most_weight));
  }
}

template <class T>
void SceneLevels<T>::lay_out_again(const std::vector<grid::CurvePair>& curves) {
  if (!std::exchange(whole_, false)) {  // or not laid out to the end, for want of memory
    hierarchy_.reset();
    cutter_.reset();
    conformer_.reset();
  }
  meter_.forget_peak();
  if (key_.conforming)
    conform_again(curves);
  else
    cut_again(curves);
  whole_ = true;
}

template <class T>
void SceneLevels<T>::cut_again(const std::vector<grid::CurvePair>& curves) {
  if (!cutter_) cutter_ = std::make_unique<grid::CurveCutter>(key_.lattice, key_.most_weight);
  grid::CutCells cuts = cutter_->cut(curves);
  if (!hierarchy_ || !same_cells(cuts, cuts_)) return build(std::move(cuts));
  cuts_ = std::move(cuts);
  hierarchy_->retarget(cuts_);
  hierarchy_->clear();
}

template <class T>
void SceneLevels<T>::conform_again(const std::vector<grid::CurvePair>& curves) {
  if (!hierarchy_) build(grid::cut({}, key_.lattice, key_.most_weight));
  if (!conformer_) conformer_ = hierarchy_->make_conformer(key_.lattice);
  std::vector<grid::ConformingCells> cells = conformer_->conform(curves);
  if (cells.empty()) {
    hierarchy_->retarget(*conformer_, 0);
    return hierarchy_->clear();
  }
  if (hierarchy_->conforming()) build(grid::cut({}, key_.lattice, key_.most_weight));
  hierarchy_->conform(std::move(cells), meter_);
}

template <class T>
void SceneLevels<T>::set_targets(const std::vector<grid::CurvePair>& curves, int top) {
  if (!key_.conforming) {
    hierarchy_->set_wanted(top, grid::cut(curves, key_.lattice, key_.most_weight).wanted);
    return;
  }
  [[maybe_unused]] const bool same = conformer_->conform(curves).empty();
  assert(same);
  hierarchy_->retarget(*conformer_, top);
}

template <class T>
SceneLevels<T>& KeptLevels::Contents::levels(LevelsKey key) {
  std::unique_ptr<SceneLevels<T>>* own = nullptr;
  if constexpr (std::is_same_v<T, float>) {
    own = &single_precision;
    double_precision.reset();
  } else {
    own = &double_precision;
    single_precision.reset();
  }
  if (!*own || !((*own)->key() == key)) {
    own->reset();  // before the new ones: they may be large
    *own = std::make_unique<SceneLevels<T>>(std::move(key));
  }
  return **own;
}

KeptLevels::KeptLevels() = default;
KeptLevels::~KeptLevels() = default;
KeptLevels::KeptLevels(KeptLevels&&) noexcept = default;
KeptLevels& KeptLevels::operator=(KeptLevels&&) noexcept = default;

KeptLevels::Contents& KeptLevels::contents() {
  if (!contents_) contents_ = std::make_unique<Contents>();
  return *contents_;
}

template class SceneLevels<float>;
template class SceneLevels<double>;
template SceneLevels<float>& KeptLevels::Contents::levels(LevelsKey);
template SceneLevels<double>& KeptLevels::Contents::levels(LevelsKey);

}  // namespace drumhead::multigrid
