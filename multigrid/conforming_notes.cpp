// SPDX-License-Identifier: MIT
#include "conforming_notes.h"

#include <map>
#include <tuple>

#include "words.h"

namespace drumhead::multigrid {
namespace {

// Smaller contradictions are not seen.
constexpr double kNotable = 0.05;  // cells

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

class Notes {
 public:
  Notes(const grid::ConformingCells& cells, const WarpProblem& problem)
      : cells_(cells), problem_(problem) {}

  std::vector<std::string> run() {
    add_conflicts();
    if (!cells_.lost_tips.empty())
      notes_.push_back(
          "tips or corners of curves without a lattice node of their own, rounded off: " +
          std::to_string(cells_.lost_tips.size()) + ", first at " +
          place(cells_.lost_tips.front()) + "; smaller cells would show them");
    if (!cells_.simplified_cells.empty())
      notes_.push_back(counted(cells_.simplified_cells.size(), "cell") +
                       " could not be divided as the curves ask, which are met at the nearest "
                       "nodes there, first at " +
                       place(cells_.simplified_cells.front()) + "; smaller cells would help");
    return std::move(notes_);
  }

 private:
  std::string place(grid::Point cells) const {
    return in_words(problem_.lattice.origin_px + problem_.lattice.cell_px * cells);
  }
  std::string curve(int n) const { return "'" + problem_.curves[std::size_t(n)].name + "'"; }
  bool on_edge(grid::Point cells) const {
    return cells.x == 0.0 || cells.y == 0.0 || cells.x == cells_.nx || cells.y == cells_.ny;
  }

  void add_conflicts() {
    struct Worst {
      std::size_t nodes = 0;
      const grid::HeldConflict* conflict = nullptr;
    };
    std::map<std::tuple<int, int, bool>, Worst> pairs;  // the last: at the fixed edge
    for (const grid::HeldConflict& conflict : cells_.conflicts) {
      if (conflict.distance < kNotable) continue;
      const bool edge = on_edge(conflict.rest);
      const auto [low, high] = std::minmax(conflict.curve, conflict.other_curve);
      Worst& worst = pairs[edge ? std::tuple{conflict.other_curve, conflict.other_curve, true}
                                : std::tuple{low, high, false}];
      ++worst.nodes;
      if (worst.conflict == nullptr || conflict.distance > worst.conflict->distance)
        worst.conflict = &conflict;
    }
    for (const auto& [pair, worst] : pairs) {
      const auto& [a, b, edge] = pair;
      const std::string distance = in_words(worst.conflict->distance * problem_.lattice.cell_px),
                        at = place(worst.conflict->rest);
      if (edge)
        notes_.push_back("curve " + curve(a) +
                         " reaches the lattice's fixed edge, which cannot follow it by " +
                         distance + " at " + at);
      else if (a == b)
        notes_.push_back("curve " + curve(a) + " asks one place for two targets up to " + distance +
                         " apart in " + counted(worst.nodes, "node") + ", most at " + at +
                         ": the lattice takes their mean");
      else
        notes_.push_back("curves " + curve(a) + " and " + curve(b) +
                         " meet but their targets are up to " + distance + " apart in " +
                         counted(worst.nodes, "node") + ", most at " + at +
                         ": hard curves rule over soft ones, equals meet in the middle");
    }
  }

  const grid::ConformingCells& cells_;
  const WarpProblem& problem_;
  std::vector<std::string> notes_;
};

}  // namespace

std::vector<std::string> conforming_notes(const grid::ConformingCells& cells,
                                          const WarpProblem& problem) {
  return Notes(cells, problem).run();
}

}  // namespace drumhead::multigrid
