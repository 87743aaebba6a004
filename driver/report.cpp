// SPDX-License-Identifier: MIT
#include "report.h"

#include <drumhead/kernels/model.h>
#include <drumhead/kernels/version.h>
#include <sys/resource.h>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace drumhead::driver {
namespace {

using Json = nlohmann::ordered_json;

Json finite(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
Json position(grid::Point p) { return Json::array({finite(p.x), finite(p.y)}); }

Json levels_json(const multigrid::SolveReport& report) {
  Json levels = Json::array();
  for (const multigrid::LevelReport& level : report.levels) {
    Json steps = Json::array();
    for (const multigrid::NewtonStep& step : level.newton) {
      steps.push_back({{"theta", finite(step.theta)},
                       {"step", finite(step.step)},
                       {"krylov", step.krylov},
                       {"residual", finite(step.residual)},
                       {"dx_rms_px", finite(step.dx_rms_px)},
                       {"dx_max_px", finite(step.dx_max_px)},
                       {"inverted_cells", step.inverted_cells}});
    }
    levels.push_back({{"nx", level.nx}, {"ny", level.ny}, {"newton", std::move(steps)}});
  }
  return levels;
}

Json curves_json(const multigrid::SolveReport& report) {
  Json curves = Json::array();
  for (const multigrid::CurveReport& curve : report.curves) {
    curves.push_back({{"name", curve.name},
                      {"length_px", finite(curve.length_px)},
                      {"gap_rms_px", finite(curve.gap_rms_px)},
                      {"gap_max_px", finite(curve.gap_max_px)},
                      {"worst_px", position(curve.worst_px)}});
  }
  return curves;
}

Json folds_json(const multigrid::FoldReport& folds) {
  Json places = Json::array();
  for (const grid::Point& place : folds.places_px) places.push_back(position(place));
  return {{"inverted_cells", folds.inverted_cells},
          {"folded_cells", folds.folded_cells},
          {"min_J", finite(folds.min_J)},
          {"min_corner_J", finite(folds.min_corner_J)},
          {"places_px", std::move(places)}};
}

Json memory_json(const multigrid::Solution& solution) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const std::size_t bytes = solution.report.solver_bytes;
  return {{"solver_bytes", bytes},
          {"bytes_per_node", finite(double(bytes) / double(solution.lattice.nodes()))},
          {"peak_rss_bytes", std::int64_t(usage.ru_maxrss) * 1024}};
}

Json frame_json(const Frame& frame) { return {frame.left, frame.top, frame.width, frame.height}; }

Json maps_json(const MapReport& maps) {
  const RoundTrip& round_trip = maps.round_trip;
  return {{"convention", name(maps.format.convention)},
          {"frame", frame_json(maps.format.frame)},
          {"round_trip_px",
           {{"rms", finite(round_trip.rms_px)},
            {"max", finite(round_trip.max_px)},
            {"sampled_rms", finite(round_trip.sampled_rms_px)},
            {"sampled_max", finite(round_trip.sampled_max_px)}}}};
}

}  // namespace

std::string report_json(const multigrid::Solution& solution, const Frame& frame,
                        const Seconds& seconds, const std::optional<MapReport>& maps) {
  const multigrid::SolveReport& report = solution.report;
  const grid::Lattice& lattice = solution.lattice;
  const multigrid::EnergyReport& energy = report.energy;
  Json json = {{"version", DRUMHEAD_VERSION},
               {"status", multigrid::name(report.status)},
               {"model", kernels::name(report.model)},
               {"exact", report.exact},
               {"solver", multigrid::name(report.solver)},
               {"curve_method", multigrid::name(report.curve_method)},
               {"lattice",
                {{"nx", lattice.nx},
                 {"ny", lattice.ny},
                 {"cell_px", finite(lattice.cell_px)},
                 {"origin_px", position(lattice.origin_px)},
                 {"levels", report.lattice_levels}}},
               {"levels", levels_json(report)},
               {"frame", frame_json(frame)},
               {"work_units", finite(report.work_units)},
               {"work_unit_seconds", finite(report.work_unit_seconds)},
               {"error_px",
                {{"algebraic_rms", finite(report.algebraic_rms_px)},
                 {"algebraic_max", finite(report.algebraic_max_px)},
                 {"discretisation_rms", finite(report.discretisation_rms_px)},
                 {"discretisation_max", finite(report.discretisation_max_px)}}},
               {"curves", curves_json(report)},
               {"folds", folds_json(report.folds)},
               {"energy",
                {{"total", finite(energy.total)},
                 {"elastic", finite(energy.elastic)},
                 {"volume", finite(energy.volume)},
                 {"constraint", finite(energy.constraint)},
                 {"volume_gap", finite(report.volume_gap)}}},
               {"seconds",
                {{"read", finite(seconds.read)},
                 {"cut", finite(seconds.cut)},
                 {"solve", finite(seconds.solve)},
                 {"render", finite(seconds.render)},
                 {"write", finite(seconds.write)},
                 {"total", finite(seconds.total)}}},
               {"memory", memory_json(solution)},
               {"isa", report.isa},
               {"threads", report.threads},
               {"notes", report.notes}};
  if (maps) json["maps"] = maps_json(*maps);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_text(const std::string& text, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  if (!(stream << text << std::flush)) {
    throw std::runtime_error(file.string() + ": cannot be written");
  }
}

}  // namespace drumhead::driver
