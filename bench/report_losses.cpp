// SPDX-License-Identifier: MIT
#include "report_losses.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// The least `key` of drumhead's solved rows that `fit` holds of.
double best_of_ours(const Rows& rows, const char* key,
                    const std::function<bool(const Json&)>& fit) {
  double least = kNever;
  for (const Json& row : rows)
    if (is_ours(row) && solved(row) && fit(row) && value(row, key) < least) least = value(row, key);
  return least;
}

Losses table1(const Rows& rows) {
  Losses found{"Whole solve of the sponge, lattice by lattice (paper's figures as printed)", {}};
  for (const auto& [key, unit, what] :
       {std::tuple{"seconds", "s", "takes"}, std::tuple{"bytes", "bytes", "needs"}})
    for (const Json& peer : rows) {
      if (is_ours(peer) || !solved(peer)) continue;
      const double theirs = value(peer, key);
      const double ours = best_of_ours(rows, key, [&](const Json& row) {
        return same(row, peer, {"n", "threads"});
      });
      if (theirs < ours && std::isfinite(ours))
        found.words.push_back(text(peer, "method") + " " + what + " " + figure(theirs) + " " +
                              unit + " at " + figure(value(peer, "n")) + "², " +
                              figure(value(peer, "threads")) +
                              (value(peer, "threads") == 1 ? " thread" : " threads") +
                              "; drumhead " + figure(ours) + " " + unit + ".");
    }
  return found;
}

/// Peers that reach an error sooner than any drumhead row with as small an error.
Losses precision(const Rows& rows, const char* key, const std::string& words) {
  Losses found{words + " against seconds, one thread", {}};
  for (const Json& peer : rows) {
    if (is_ours(peer) || !solved(peer) || !std::isfinite(value(peer, key))) continue;
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

/// At the same number of cells, whoever is more accurate than drumhead's default, averaged, way.
Losses same_lattice(const Rows& rows) {
  Losses found{"Error on as many cells (time left aside), against drumhead's better way", {}};
  for (const Json& peer : rows) {
    if (is_ours(peer) || !solved(peer)) continue;
    const double ours = best_of_ours(rows, "rms_px", [&](const Json& row) {
      return same(row, peer, {"scene", "kappa", "n"});
    });
    if (value(peer, "rms_px") < ours && std::isfinite(ours))
      found.words.push_back(
          scene_of(peer) + ", " + figure(value(peer, "n")) + "²: " + text(peer, "method") +
          " leaves " + figure(value(peer, "rms_px")) + " px RMS, drumhead " + figure(ours) + ".");
  }
  return found;
}

Losses warps(const Rows& rows) {
  Losses found{"Warps of other kinds (they solve another problem: no area is kept)", {}};
  const struct {
    const char *key, *words, *unit;
    double scale;
  } measures[] = {{"seconds", "is faster", " s", 1.0},
                  {"gap_rms_px", "meets the curves more closely", " px RMS", 1.0},
                  {"folded_share", "folds less of the picture", " %", 100.0},
                  {"rms_J", "keeps areas better", " RMS(J−1)", 1.0}};
  for (const auto& m : measures)
    for (const Json& peer : rows) {
      if (is_ours(peer)) continue;
      const double ours =
          best_of_ours(rows, m.key, [&](const Json& row) { return same(row, peer, {"scene"}); });
      if (value(peer, m.key) < ours)
        found.words.push_back(scene_of(peer) + ": " + text(peer, "method") + " " + m.words + ": " +
                              figure(m.scale * value(peer, m.key)) + m.unit + ", drumhead " +
                              figure(m.scale * ours) + m.unit + ".");
    }
  return found;
}

Losses rates(const Rows& rows) {
  Losses found{"One Newton system: work for a factor of ten, against drumhead's default gcr", {}};
  for (const Json& ours : rows) {
    if (text(ours, "solver") != "gcr") continue;
    const std::string where =
        scene_of(ours) + ", " + figure(value(ours, "n")) + "²" +
        (std::isfinite(value(ours, "weight")) ? ", d " + figure(value(ours, "weight"))
                                              : std::string()) +
        (ours.value("exact", false) ? ", exact" : "");
    if (!ours.value("converged", true)) found.words.push_back(where + ": gcr does not converge.");
    for (const Json& peer : rows)
      if (!text(peer, "solver").starts_with("gcr") && peer.value("converged", true) &&
          same(ours, peer, {"scene", "kappa", "n", "weight", "exact"}) &&
          value(peer, "work_units_per_digit") < value(ours, "work_units_per_digit"))
        found.words.push_back(where + ": " + text(peer, "solver") + " takes " +
                              figure(value(peer, "work_units_per_digit")) + " work units, gcr " +
                              figure(value(ours, "work_units_per_digit")) + ".");
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
  for (const Json& row : rows) {
    const bool peer = row.contains("method") && !is_ours(row);
    const bool hard_case = text(row, "table") == "stability";
    if (peer || (hard_case ? row.value("passed", false) : solved(row))) continue;
    std::string line = text(row, "table") + ": " + text(row, "case");
    if (row.contains("scene")) line += scene_of(row);
    if (row.contains("n")) line += ", " + figure(value(row, "n")) + "²";
    for (const char* key : {"method", "model", "curves"})
      if (row.contains(key)) line += ", " + text(row, key);
    found.words.push_back(line + ": " + text(row, hard_case ? "ended" : "status") + ".");
  }
  return found;
}

}  // namespace

std::vector<Losses> losses(const Measurements& measured) {
  const Rows first = measured.table("table1"), all = measured.table("work_precision"),
             other = measured.table("warps"), linear = measured.table("rates"),
             loops = measured.table("kernels"), pictures = measured.table("resample");
  std::vector<Losses> found;
  if (!first.empty()) found.push_back(table1(first));
  if (!all.empty()) {
    found.push_back(precision(all, "rms_px", "RMS error"));
    found.push_back(precision(all, "max_px", "Largest error"));
    found.push_back(precision(all, "gap_rms_px", "Curve gap"));
    found.push_back(same_lattice(all));
  }
  if (!other.empty()) found.push_back(warps(other));
  if (!linear.empty()) found.push_back(rates(linear));
  if (!loops.empty()) found.push_back(kernels(loops));
  if (!pictures.empty()) found.push_back(samplers(pictures));
  found.push_back(unsolved(measured.rows));
  return found;
}

}  // namespace drumhead::bench
