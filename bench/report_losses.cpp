// SPDX-License-Identifier: MIT
#include "report_losses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace drumhead::bench {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

bool solved(const Json& row) {
  const std::string status = text(row, "status");
  return status.empty() || status == "converged";
}

std::string scene_of(const Json& row) {
  const std::string scene = text(row, "scene");
  return row.contains("kappa") ? scene + " kappa " + figure(value(row, "kappa")) : scene;
}

bool same(const Json& a, const Json& b, std::initializer_list<const char*> keys) {
  return std::ranges::all_of(
      keys, [&](const char* key) { return a.value(key, Json()) == b.value(key, Json()); });
}

/// Drumhead's own solver, not one of the paper's or a textbook's in its Newton iteration.
bool is_default(const Json& row) {
  const std::string method = text(row, "method");
  return method == "drumhead" || method == "drumhead, averaged" || method == "drumhead, conforming";
}

/// The method without drumhead's name before it.
std::string way_of(const Json& row) {
  const std::string method = text(row, "method"), ours = "drumhead, ";
  return method.starts_with(ours) ? method.substr(ours.size()) : method;
}

/// Appends to words that a sentence lists.
void list(std::string& words, const std::string& more, const char* between = "; ") {
  words += (words.empty() ? "" : between) + more;
}

/// The least `key` of drumhead's solved rows that `fit` holds of.
double best_of_ours(const Rows& rows, const char* key,
                    const std::function<bool(const Json&)>& fit) {
  double least = kNever;
  for (const Json& row : rows)
    if (is_default(row) && solved(row) && fit(row) && value(row, key) < least)
      least = value(row, key);
  return least;
}

std::string threads_of(const Json& row) {
  return figure(value(row, "threads")) + (value(row, "threads") == 1 ? " thread" : " threads");
}

Losses table1(const Rows& rows) {
  Losses found{"Whole solve of the sponge, lattice by lattice (paper's figures as printed)", {}};
  for (const auto& [key, unit, what, scale] :
       {std::tuple{"seconds", " s", "takes ", 1.0}, std::tuple{"bytes", " MB", "needs ", 1e-6}})
    for (const Json& peer : rows) {
      if (is_ours(peer) || !solved(peer)) continue;
      std::string ours;
      for (const Json& row : rows)
        if (is_default(row) && solved(row) && same(row, peer, {"n", "threads"}) &&
            value(peer, key) < value(row, key))
          list(ours, way_of(row) + " " + figure(scale * value(row, key)) + unit);
      if (!ours.empty())
        found.words.push_back(text(peer, "method") + " " + what + figure(scale * value(peer, key)) +
                              unit + " at " + figure(value(peer, "n")) + "², " + threads_of(peer) +
                              "; drumhead, " + ours + ".");
    }
  return found;
}

/// Seconds on one thread by the row's; NaN where one was not measured.
double gain_of(const Rows& rows, const Json& row) {
  for (const Json& alone : rows)
    if (value(alone, "threads") == 1 && same(alone, row, {"method", "n"}))
      return value(alone, "seconds") / value(row, "seconds");
  return std::numeric_limits<double>::quiet_NaN();
}

/// Where threads gain nothing, or less than they gain a peer.
Losses threads(const Rows& rows) {
  Losses found{"Gain of threads, the sponge (the paper's six cores were not tried)", {}};
  for (const Json& ours : rows) {
    if (!is_default(ours) || value(ours, "threads") == 1) continue;
    const double gain = gain_of(rows, ours);
    std::string more;
    for (const Json& peer : rows)
      if (!is_ours(peer) && same(peer, ours, {"n", "threads"}) && gain_of(rows, peer) > gain)
        list(more, text(peer, "method") + " " + figure(gain_of(rows, peer)), ", ");
    if (gain < 1.0 || !more.empty())
      found.words.push_back(text(ours, "method") + ", " + figure(value(ours, "n")) +
                            "²: " + threads_of(ours) + " are " + figure(gain) +
                            " times as fast as one" + (more.empty() ? "" : "; " + more) + ".");
  }
  return found;
}

/// Peers that reach an error sooner than any drumhead row with as small an error.
Losses precision(const Rows& rows, const char* key, const std::string& words) {
  Losses found{words + " against seconds, one thread", {}};
  for (const Json& peer : rows) {
    if (is_default(peer) || !solved(peer) || !std::isfinite(value(peer, key))) continue;
    const double seconds = best_of_ours(rows, "seconds", [&](const Json& row) {
      return same(row, peer, {"scene", "kappa"}) && value(row, key) <= value(peer, key);
    });
    const double least = best_of_ours(rows, key, [&](const Json& row) {
      return same(row, peer, {"scene", "kappa"});
    });
    if (!(value(peer, "seconds") < seconds) || !std::isfinite(least)) continue;
    std::string line = scene_of(peer) + ": " + text(peer, "method") + " at " +
                       figure(value(peer, "n")) + "² reaches " + figure(value(peer, key)) +
                       " px in " + figure(value(peer, "seconds")) + " s; drumhead ";
    line += std::isfinite(seconds)
                ? "needs " + figure(seconds) + " s."
                : "does not on the lattices tried (its best: " + figure(least) + " px).";
    found.words.push_back(line);
  }
  return found;
}

/// At the same number of cells, whoever is more accurate than one of drumhead's ways.
Losses same_lattice(const Rows& rows) {
  // Solvers of the same equations, stopped by the same rule, end within a tenth of each other.
  constexpr double kSame = .9;
  Losses found{"Error on as many cells, RMS (largest), px, time left aside", {}};
  const auto errors = [](const Json& row) {
    return figure(value(row, "rms_px")) + " (" + figure(value(row, "max_px")) + ")";
  };
  for (const Json& peer : rows) {
    if (is_ours(peer) || !solved(peer)) continue;
    std::string ours;
    for (const Json& row : rows)
      if (is_default(row) && solved(row) && same(row, peer, {"scene", "kappa", "n"}) &&
          (value(peer, "rms_px") < kSame * value(row, "rms_px") ||
           value(peer, "max_px") < kSame * value(row, "max_px")))
        list(ours, way_of(row) + " " + errors(row));
    if (!ours.empty())
      found.words.push_back(scene_of(peer) + ", " + figure(value(peer, "n")) +
                            "²: " + text(peer, "method") + " " + errors(peer) + "; drumhead, " +
                            ours + ".");
  }
  return found;
}

Losses folds(const Rows& rows) {
  Losses found{"Folds on as many cells (cells with a folded corner; of a mesh: triangles)", {}};
  for (const Json& peer : rows) {
    if (is_ours(peer) || !solved(peer)) continue;
    std::string ours;
    for (const Json& row : rows)
      if (is_default(row) && solved(row) && same(row, peer, {"scene", "kappa", "n"}) &&
          value(peer, "folded") < value(row, "folded"))
        list(ours, way_of(row) + " " + figure(value(row, "folded")));
    if (!ours.empty())
      found.words.push_back(scene_of(peer) + ", " + figure(value(peer, "n")) +
                            "²: " + text(peer, "method") + " " + figure(value(peer, "folded")) +
                            "; drumhead, " + ours + ".");
  }
  return found;
}

Losses warps(const Rows& rows) {
  Losses found{"Warps of other kinds (they solve another problem: no area is kept)", {}};
  const struct {
    const char *key, *words, *unit;
    double scale;
  } measures[] = {{"seconds", "is faster", "s", 1.0},
                  {"gap_rms_px", "meets the curves more closely", "px RMS", 1.0},
                  {"folded_share", "folds less of the picture", "%", 100.0},
                  {"rms_J", "keeps areas better", "RMS(J−1)", 1.0}};
  const auto name = [](const Json& row) { return scene_of(row) + ": " + text(row, "method"); };
  const Rows peers = where(rows, [](const Json& row) { return !is_ours(row); });
  for (const auto& m : measures)
    for (const std::string& peer : distinct(peers, name)) {
      std::string theirs, ours;
      for (const Json& row : rows) {
        const auto beats = [&](const Json& a, const Json& b) {
          return value(a, m.key) < value(b, m.key) && same(a, b, {"scene"});
        };
        const std::string number = figure(m.scale * value(row, m.key));
        if (name(row) == peer && std::ranges::any_of(rows, [&](const Json& other) {
              return is_default(other) && beats(row, other);
            }))
          list(theirs, number + " (" + figure(value(row, "points")) + " points)", ", ");
        if (is_default(row) && std::ranges::any_of(peers, [&](const Json& other) {
              return name(other) == peer && beats(other, row);
            }))
          list(ours, way_of(row) + " at kappa " + figure(value(row, "kappa")) + " " + number, ", ");
      }
      if (!ours.empty())
        found.words.push_back(peer + " " + m.words + ", " + m.unit + ": " + theirs +
                              "; drumhead, " + ours + ".");
    }
  return found;
}

Losses rates(const Rows& rows) {
  Losses found{"One Newton system: work for a factor of ten, against drumhead's default gcr", {}};
  for (const Json& ours : rows) {
    const std::string solver = text(ours, "solver");
    if (!solver.starts_with("gcr")) continue;
    const std::string where =
        scene_of(ours) + ", " + figure(value(ours, "n")) + "²" +
        (std::isfinite(value(ours, "weight")) ? ", d " + figure(value(ours, "weight"))
                                              : std::string()) +
        (ours.value("exact", false) ? ", exact" : "");
    if (!ours.value("converged", true))
      found.words.push_back(where + ": " + solver + " does not converge.");
    for (const Json& peer : rows)
      if (!text(peer, "solver").starts_with("gcr") && peer.value("converged", true) &&
          same(ours, peer, {"scene", "kappa", "n", "weight", "exact"}) &&
          value(peer, "work_units_per_digit") < value(ours, "work_units_per_digit"))
        found.words.push_back(where + ": " + text(peer, "solver") + " takes " +
                              figure(value(peer, "work_units_per_digit")) + " work units, " +
                              solver + " " + figure(value(ours, "work_units_per_digit")) + ".");
  }
  return found;
}

Losses kernels(const Rows& rows) {
  Losses found{"Hessian–vector product against other people's, one thread", {}};
  for (const Json& row : rows)
    if (value(row, "against") < 1.0)
      found.words.push_back(text(row, "kernel") + ", " + figure(value(row, "n")) + "² (" +
                            text(row, "memory") + "): " + figure(value(row, "against")) +
                            " of our product's time.");
  return found;
}

Losses samplers(const Rows& rows) {
  Losses found{"Resampler: faster samplers, and sharper ones", {}};
  for (const std::string& sampler : distinct(rows, [](const Json& row) {
         return text(row, "sampler") + ", " + text(row, "filter");
       })) {
    std::string faster, sharper;
    for (const Json& row : rows) {
      if (text(row, "sampler") + ", " + text(row, "filter") != sampler ||
          sampler.starts_with("drumhead"))
        continue;
      const std::string warp = text(row, "warp");
      if (value(row, "by_ours") < 1.0)
        faster += (faster.empty() ? "" : "; ") + figure(1.0 / value(row, "by_ours")) +
                  " times as fast " + "(" + warp + ")";
      for (const Json& ours : rows)
        if (text(ours, "sampler").starts_with("drumhead") && text(ours, "warp") == warp &&
            value(row, "psnr_db") > value(ours, "psnr_db"))
          sharper += (sharper.empty() ? "" : "; ") + figure(value(row, "psnr_db")) + " dB to our " +
                     figure(value(ours, "psnr_db")) + " (" + warp + ")";
    }
    if (!faster.empty()) found.words.push_back(sampler + ": " + faster + ".");
    if (!sharper.empty()) found.words.push_back(sampler + ": " + sharper + ".");
  }
  return found;
}

Losses unsolved(const Rows& rows) {
  Losses found{"Solves of drumhead's own that did not converge, or not as the tests expect", {}};
  // Lattices of which the same is said are named together.
  std::map<std::string, std::string> lattices;
  std::vector<std::string> lines;
  for (const Json& row : rows) {
    const std::string table = text(row, "table");
    const bool peer = row.contains("method") && table != "study" && !is_ours(row);
    const bool hard_case = table == "stability" || table == "study";
    const std::string ended = text(row, hard_case ? "ended" : "status");
    if (peer || (hard_case ? row.value("passed", ended == "converged") : solved(row))) continue;
    std::string line = table + ": " + text(row, "case");
    if (row.contains("scene")) line += scene_of(row);
    for (const char* key : {"method", "model", "curves"})
      if (row.contains(key)) line += ", " + text(row, key);
    line += ": " + ended;
    if (!lattices.contains(line)) lines.push_back(line);
    if (row.contains("n")) list(lattices[line], figure(value(row, "n")) + "²", ", ");
  }
  for (const std::string& line : lines)
    found.words.push_back(line + (lattices[line].empty() ? "" : " at " + lattices[line]) + ".");
  return found;
}

}  // namespace

std::vector<Losses> losses(const Measurements& measured) {
  const Rows first = measured.table("table1"), all = measured.table("work_precision"),
             other = measured.table("warps"), linear = measured.table("rates"),
             loops = measured.table("kernels"), pictures = measured.table("resample");
  std::vector<Losses> found;
  if (!first.empty()) {
    found.push_back(table1(first));
    found.push_back(threads(first));
  }
  if (!all.empty()) {
    found.push_back(precision(all, "rms_px", "RMS error"));
    found.push_back(precision(all, "max_px", "Largest error"));
    found.push_back(precision(all, "gap_rms_px", "Curve gap"));
    found.push_back(same_lattice(all));
    found.push_back(folds(all));
  }
  if (!other.empty()) found.push_back(warps(other));
  if (!linear.empty()) found.push_back(rates(linear));
  if (!loops.empty()) found.push_back(kernels(loops));
  if (!pictures.empty()) found.push_back(samplers(pictures));
  found.push_back(unsolved(measured.rows));
  return found;
}

}  // namespace drumhead::bench
