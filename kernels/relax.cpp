// SPDX-License-Identifier: MIT
#include <drumhead/kernels/relax.h>

#include <drumhead/kernels/refuse.h>
#include <algorithm>
#include <array>
#include <utility>

#include "isotropic.h"
#include "kernel_table.h"
#include "parallel.h"
#include "restriction.h"
#include "special_sweeps.h"

namespace drumhead::kernels {

template <class T>
RowScratch<T>::RowScratch(int columns, int threads)
    : odd_(((columns + 1) / 2 + 15) / 16 * 16),
      storage_(std::size_t(threads) * (11 + 4) * 2 * std::size_t(odd_)),
      rows_(std::size_t(threads)) {
  T* at = storage_.data();
  for (Rows& rows : rows_) {
    for (T*& row : rows.x) row = std::exchange(at, at + 2 * odd_);
    for (T*& row : rows.y) row = std::exchange(at, at + 2 * odd_);
    for (T*& row : rows.p) row = std::exchange(at, at + 2 * odd_);
    rows.kept = std::exchange(at, at + 8 * odd_);
    for (T*& half : rows.share.half) half = std::exchange(at, at + odd_);
    std::fill_n(rows.share.half[0], 2 * odd_, T(1));
  }
}

template <class T>
void RowScratch<T>::forget() {
  for (Rows& rows : rows_) {
    std::fill_n(rows.held, 4, -1);
    rows.next = -1;
  }
}

template <class T>
T* RowScratch<T>::parts(int count) {
  if (parts_.size() < std::size_t(count)) parts_.resize(std::size_t(count));
  return parts_.data();
}

template <class T>
T* RowScratch<T>::curves(int count) {
  if (curves_.size() < std::size_t(count)) curves_.resize(std::size_t(count));
  return curves_.data();
}

namespace {

template <class T>
void clear_row(const Plane<T>& plane, int j) {
  for (int parity = 0; parity < 2; ++parity)
    std::fill_n(plane.half(j, parity), half_count(plane.columns, parity), T(0));
}

/// The sweeps of one relaxation in order.
enum class Sweep { clear, prolong, start, nodes, near, volume, cuts, nothing, restriction };
struct Stage {
  Sweep sweep;
  int colour = 0;  ///< of nodes, or parity of the rows
  bool reverse = false;
  bool band = false;  ///< of nodes and volume rows, those beside the curves alone
};

/// At most two relaxations of a band.
struct StageList {
  std::array<Stage, 48> at{};
  int count = 0;
  void add(Stage stage) { at[std::size_t(count++)] = stage; }
};

/// Volume rows, curve rows, and both in reverse.
void add_rows(VolumeSweeps sweeps, bool band, bool volume, bool cuts, StageList& list) {
  for (bool reverse : {false, true}) {
    const std::array<int, 2> rows = reverse ? std::array{1, 0} : std::array{0, 1};
    auto add = [&](Sweep sweep) {
      for (int parity : rows) list.add({sweep, parity, reverse, band});
    };
    if (volume && !reverse && sweeps != VolumeSweeps::reverse) add(Sweep::volume);
    if (cuts) add(Sweep::cuts);
    if (volume && reverse && sweeps != VolumeSweeps::forwards) add(Sweep::volume);
  }
}

StageList list_stages(const RelaxStages& stages, bool prolong, bool near, bool volume, bool cuts,
                      bool restriction) {
  if (stages.band < 0 || stages.band > 2) refuse("band", stages.band, "0…2");
  StageList list;
  if (stages.from_zero) list.add({Sweep::clear});
  if (prolong) list.add({Sweep::prolong});
  const int first = stages.sweeps == Sweeps::nodes_reversed ? 1 : 0;
  // The first half sweep from zero needs no stencil: it starts red, and nothing is prolonged.
  const bool start = stages.from_zero && !prolong && first == 0;
  if (stages.sweeps != Sweeps::none)
    for (int colour : {first, 1 - first})
      list.add({start && colour == 0 ? Sweep::start : Sweep::nodes, colour});
  // Near nodes see all eight neighbours: those of a row follow one another, rows of one parity do
  // not see each other.
  if (near && stages.sweeps != Sweeps::none)
    for (int parity : {0, 1}) list.add({Sweep::near, parity});
  if (stages.sweeps == Sweeps::all) add_rows(stages.volume, false, volume, cuts, list);
  for (int n = 0; n < stages.band && (cuts || near); ++n) {
    for (int colour : {0, 1}) list.add({Sweep::nodes, colour, false, true});
    if (near)
      for (int parity : {0, 1}) list.add({Sweep::near, parity});
    add_rows(near ? VolumeSweeps::reverse : stages.volume, true, volume, cuts, list);
  }
  if (restriction) {
    // It looks three rows back: an empty stage keeps it clear of the sweep before.
    list.add({Sweep::nothing});
    list.add({Sweep::restriction});
  }
  return list;
}

/// The sweeps on row j.
template <class T>
class Relaxation {
 public:
  explicit Relaxation(const LevelSystem<T>& level) : level_(level), kernels_(table<T>()) {}

  void clear(int j) const {
    clear_row(d_.x, j);
    clear_row(d_.y, j);
    if (special_) clear_curve_row(*special_, d_, j);
    if (!d_.p) return;
    clear_row(d_.p, j);
    if (special_) clear_part_row(special_->cells(), d_.listed, j);
  }
  void prolong(const Unknowns<const T>& coarse, int j) const {
    if (j > 0) {
      kernels_.add_prolonged_nodes(coarse.x, d_.x, j);
      kernels_.add_prolonged_nodes(coarse.y, d_.y, j);
    }
    if (d_.p) kernels_.prolong_cells(coarse.p, d_.p, j);
    if (special_) finish_prolongation(*special_, *level_.transfer, coarse, d_, j);
  }
  void start(T* kept, int j) const {
    keeping_near(0, kept, j, [&] { kernels_.start_nodes(level_.membrane, f_, d_, j); });
  }
  void nodes(int colour, T* kept, int j) const {
    keeping_near(colour, kept, j,
                 [&] { kernels_.relax_nodes(level_.membrane, f_, d_, colour, {}, j); });
  }
  void near(int j) const {
    relax_near_row(*special_, f_, d_, j);
    relax_curve_row(*special_, f_, d_, j);
  }
  void band_nodes(int colour, T* kept, int j) const {
    const Spans spans = level_.band->row(j);
    if (spans.first == spans.last) return;
    keeping_near(colour, kept, j,
                 [&] { kernels_.relax_nodes(level_.membrane, f_, d_, colour, spans, j); });
  }
  void band_volume(bool reverse, T* kept, int j) const {
    const Spans spans = level_.band->row(j);
    const auto sweep = [&] {
      if (spans.first == spans.last) return;
      for (const int parity : {int(reverse), int(!reverse)})
        kernels_.relax_volume_spans(level_.membrane, f_, d_, parity, spans, j);
    };
    if (!special_ || special_->regular_row(j)) return sweep();
    relax_volume_and_parts(*special_, level_.f, d_, reverse, j, kept, sweep);
  }
  void volume(bool reverse, typename RowScratch<T>::Rows& rows, int j) const {
    const auto sweep = [&](const SplitRow<const T>& share) {
      kernels_.relax_volume(level_.membrane, f_, d_, reverse, share, j);
    };
    if (!special_ || special_->regular_row(j)) return sweep({});
    relax_volume_and_parts(*special_, level_.f, d_, reverse, j, rows.kept,
                           [&] { without_special_cells(*special_, j, rows.share, sweep); });
  }
  void cuts(bool reverse, int j) const {
    relax_cuts_row(level_.membrane, level_.cuts, level_.fq, level_.dq, d_, level_.f, reverse, j);
  }

 private:
  template <class F>
  void keeping_near(int colour, T* kept, int j, F&& sweep) const {
    if (special_)
      keep_near_row(*special_, d_, (j + colour) & 1, j, kept, sweep);
    else
      sweep();
  }

  const LevelSystem<T>& level_;
  const KernelTable<T>& kernels_;
  const SpecialRows<T>* special_ = level_.membrane.special;
  const Unknowns<T>& d_ = level_.d;
  const Unknowns<const T> f_ = level_.f;
};

}  // namespace

template <class T>
void relax(const LevelSystem<T>& level, const RelaxStages& stages,
           const Unknowns<const T>* coarse_d, const Unknowns<T>* coarse_f, RowScratch<T>& scratch) {
  if (isotropic(level.membrane.law.model))
    return relax_isotropic(level, stages.from_zero, coarse_d, coarse_f);
  if (stages.band != 0 && level.band == nullptr)
    refuse("band", stages.band, "0 where the level has no LevelSystem::band");
  const int ny = level.d.x.rows - 1;
  const StageList list = list_stages(stages, coarse_d != nullptr, level.membrane.special != nullptr,
                                     bool(level.d.p), level.cuts.count > 0, coarse_f != nullptr);
  const Unknowns<T> nowhere{};
  Restriction<T> restriction(level, coarse_f ? *coarse_f : nowhere, scratch);
  const Relaxation<T> relaxation(level);
  skewed_sweeps(ny, list.count, level.d.x.columns, [&](int s, int j, int thread) {
    const Stage& stage = list.at[std::size_t(s)];
    typename RowScratch<T>::Rows& rows = scratch.rows(thread);
    switch (stage.sweep) {
      case Sweep::clear:
        relaxation.clear(j);
        break;
      case Sweep::prolong:
        relaxation.prolong(*coarse_d, j);
        break;
      case Sweep::start:
        if (j > 0) relaxation.start(rows.kept, j);
        break;
      case Sweep::nodes:
        if (j == 0) break;
        if (stage.band)
          relaxation.band_nodes(stage.colour, rows.kept, j);
        else
          relaxation.nodes(stage.colour, rows.kept, j);
        break;
      case Sweep::near:
        if ((j & 1) == stage.colour) relaxation.near(j);
        break;
      case Sweep::volume:
        if ((j & 1) != stage.colour) break;
        if (stage.band)
          relaxation.band_volume(stage.reverse, rows.kept, j);
        else
          relaxation.volume(stage.reverse, rows, j);
        break;
      case Sweep::cuts:
        if ((j & 1) == stage.colour) relaxation.cuts(stage.reverse, j);
        break;
      case Sweep::nothing:
        break;
      case Sweep::restriction:
        restriction(j, thread);
        break;
    }
  });
  if (coarse_f) restriction.finish();
}

template <class T>
double residual_norm2(const LevelSystem<T>& level, RowScratch<T>& scratch) {
  if (isotropic(level.membrane.law.model)) return isotropic_residual_norm2(level);
  const KernelTable<T>& kernels = table<T>();
  const Unknowns<const T> d = level.d, f = level.f;
  const int rows = d.x.rows - 1;
  const double volume_weight =
      1.0 / (double(level.membrane.spacing) * double(level.membrane.spacing));
  scratch.forget();
  T* parts = part_residuals(level.membrane, scratch);
  thread_local std::vector<double> of_row;  // of the calling thread, kept from call to call
  of_row.resize(static_cast<std::size_t>(rows));
  double* const at = of_row.data();
  for_chunks_of_rows(0, rows, d.x.columns, [&](int first, int last, int thread) {
    typename RowScratch<T>::Rows& buffer = scratch.rows(thread);
    LinearRows<T> linear(d.x.columns);
    auto square = [&](T* row, int columns) {
      const Plane<const T> plane{row, 0, scratch.odd(), columns, 1};
      return kernels.dot(plane, plane, 0);
    };
    auto split = [&](T* row) { return SplitRow<T>{{row, row + scratch.odd()}}; };
    for (int j = first; j < last; ++j) {
      residual_row(linear, buffer.next, level.membrane, f, d, split(buffer.x[0]),
                   split(buffer.y[0]), split(buffer.p[0]), j);
      double sum = 0.0;
      if (j > 0) sum = square(buffer.x[0], d.x.columns) + square(buffer.y[0], d.x.columns);
      if (d.p) {
        if (parts) overwrite_part_row(*level.membrane.special, &f, d, split(buffer.p[0]), parts, j);
        sum += volume_weight * square(buffer.p[0], d.p.columns);
        if (parts) sum += volume_weight * part_squares(level.membrane.special->cells(), parts, j);
      }
      at[j] = sum;
    }
  });
  double total = 0.0;
  for (const double sum : of_row) total += sum;
  if (level.membrane.special) total += curve_squares(*level.membrane.special, f, d);
  return total;
}

template double residual_norm2(const LevelSystem<float>&, RowScratch<float>&);
template double residual_norm2(const LevelSystem<double>&, RowScratch<double>&);
template class RowScratch<float>;
template class RowScratch<double>;
template void relax(const LevelSystem<float>&, const RelaxStages&, const Unknowns<const float>*,
                    const Unknowns<float>*, RowScratch<float>&);
template void relax(const LevelSystem<double>&, const RelaxStages&, const Unknowns<const double>*,
                    const Unknowns<double>*, RowScratch<double>&);

}  // namespace drumhead::kernels
