// SPDX-License-Identifier: MIT
#include "page_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "html.h"

namespace drumhead::driver {
namespace {

constexpr double kWidth = 520, kHeight = 280;
constexpr double kLeft = 52, kRight = 12, kTop = 40, kBottom = 12;

bool shown(double value) { return std::isfinite(value) && value > 0.0; }

template <class... Numbers>
std::string format(const char* text, Numbers... numbers) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, text, numbers...);
  return buffer;
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_(plot) {
    double least = std::numeric_limits<double>::infinity(), greatest = -least;
    const auto hold = [&](double value) {
      if (!shown(value)) return;
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    };
    for (const PlotLevel& level : plot.levels) {
      for (const PlotStep& step : level.steps) hold(step.value);
      steps_ += level.steps.size();
    }
    hold(plot.bound);
    if (!(least <= greatest)) least = greatest = 1.0;
    low_ = std::floor(std::log10(least));
    high_ = std::max(low_ + 1.0, std::ceil(std::log10(greatest)));
  }

  std::string svg() {
    text_ = format("<svg viewBox=\"0 0 %g %g\" role=\"img\">", kWidth, kHeight);
    add("<title>" + html::escaped(plot_.title) + "</title>");
    add("<text x=\"4\" y=\"14\">" + html::escaped(plot_.title) + "</text>");
    add_bands();
    add_decades();
    if (shown(plot_.bound)) {
      const double y = y_of(plot_.bound);
      add(format("<line class=\"bound\" x1=\"%g\" x2=\"%g\" y1=\"%.1f\" y2=\"%.1f\"/>", kLeft,
                 kWidth - kRight, y, y));
      add(format("<text class=\"bound\" x=\"%g\" y=\"%.1f\" text-anchor=\"end\">",
                 kWidth - kRight - 2, y - 4) +
          html::escaped(plot_.bound_name) + "</text>");
    }
    add_steps();
    return text_ + "</svg>";
  }

 private:
  void add(const std::string& part) { text_ += part + "\n"; }

  double x_of(std::size_t step) const {
    return kLeft + (kWidth - kLeft - kRight) * (double(step) + 0.5) /
                       double(std::max<std::size_t>(1, steps_));
  }
  double y_of(double value) const {
    constexpr double kRoom = 0.1;  // decades above the highest, for a mark's label
    return kTop + (kHeight - kTop - kBottom) * (high_ + kRoom - std::log10(value)) /
                      (high_ + kRoom - low_);
  }

  void add_bands() {
    std::size_t first = 0;
    const double half = (x_of(1) - x_of(0)) / 2;
    for (std::size_t k = 0; k < plot_.levels.size(); ++k) {
      const PlotLevel& level = plot_.levels[k];
      if (level.steps.empty()) continue;
      const double left = x_of(first) - half;
      const double width = 2 * half * double(level.steps.size());
      if (k % 2 == 0) {
        add(format("<rect class=\"band\" x=\"%.1f\" y=\"%g\" width=\"%.1f\" height=\"%g\"/>", left,
                   kTop - 18, width, kHeight - kTop - kBottom + 18));
      }
      add(format("<text x=\"%.1f\" y=\"%g\" text-anchor=\"middle\">", left + width / 2, kTop - 6) +
          html::escaped(level.name) + "</text>");
      first += level.steps.size();
    }
  }

  void add_decades() {
    const int every = std::max(1, int(std::ceil((high_ - low_) / 8)));
    for (double decade = low_; decade <= high_; decade += every) {
      const double y = y_of(std::pow(10.0, decade));
      add(format("<line class=\"grid\" x1=\"%g\" x2=\"%g\" y1=\"%.1f\" y2=\"%.1f\"/>", kLeft,
                 kWidth - kRight, y, y));
      add(format("<text x=\"%g\" y=\"%.1f\" text-anchor=\"end\">%g</text>", kLeft - 5, y + 4,
                 std::pow(10.0, decade)));
    }
  }

  void add_steps() {
    std::size_t at = 0;
    for (const PlotLevel& level : plot_.levels) {
      std::string line, marks;
      for (const PlotStep& step : level.steps) {
        const double x = x_of(at++);
        if (!shown(step.value)) continue;
        const double y = y_of(step.value);
        line += format("%.1f,%.1f ", x, y);
        marks += format("<circle class=\"mark\" cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\">", x, y) +
                 format("<title>%.3g</title></circle>\n", step.value);
        if (step.label.empty()) continue;
        marks += format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">", x, y - 7) +
                 html::escaped(step.label) + "</text>\n";
      }
      add("<polyline class=\"line\" points=\"" + line + "\"/>");
      text_ += marks;
    }
  }

  const Plot& plot_;
  std::size_t steps_ = 0;
  double low_ = 0.0, high_ = 1.0;  // decades
  std::string text_;
};

}  // namespace

std::string svg_of(const Plot& plot) { return Drawing(plot).svg(); }

}  // namespace drumhead::driver
