// SPDX-License-Identifier: MIT
#include "svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

#include "html.h"

namespace drumhead::bench {
namespace {

constexpr double kWidth = 760, kHeight = 410;
constexpr double kLeft = 68, kRight = 296, kTop = 36, kBottom = 54;
constexpr double kMark = 4.0, kLine = 18.0;
// Names of ticks and labels of points closer than this are left out.
constexpr double kTickApart = 25.0, kLabelApart = 26.0;

constexpr int kLooks = 13;
// After Okabe and Ito's colours, which people with any colour sense tell apart, darker on white and
// lighter on black.
constexpr const char* kLight[kLooks] = {"#0072b2", "#3a9bd9", "#c24e00", "#b97a00", "#007a5a",
                                        "#b0508a", "#6b7178", "#8a6d3b", "#5b4bb5", "#a11d33",
                                        "#4d7a00", "#00808a", "#303030"};
constexpr const char* kDark[kLooks] = {"#56aee8", "#9fd3f7", "#ff8a4a", "#f0c04a", "#3fc79a",
                                       "#e79cc8", "#a3a9b0", "#c8ad7f", "#a79cf0", "#ff7b8e",
                                       "#a4cf52", "#4fd0da", "#e0e0e0"};

template <class... Numbers>
std::string format(const char* text, Numbers... numbers) {
  char buffer[240];
  std::snprintf(buffer, sizeof buffer, text, numbers...);
  return buffer;
}

/// Values to positions along one axis.
class Axis {
 public:
  Axis(bool logarithmic, double from, double to) : log_(logarithmic), from_(from), to_(to) {}

  bool shows(double value) const { return std::isfinite(value) && (!log_ || value > 0.0); }
  void hold(double value) {
    if (!shows(value)) return;
    low_ = std::min(low_, along(value));
    high_ = std::max(high_, along(value));
  }
  /// Widens the range to what looks well, once all values are held.
  void settle() {
    if (!(low_ <= high_)) low_ = high_ = log_ ? 0.0 : 0.5;
    if (!log_) low_ = std::min(low_, 0.0);
    const double room = std::max(0.05 * (high_ - low_), log_ ? 0.05 : 0.0);
    if (log_ || low_ < 0.0) low_ -= room;
    high_ += room;
    if (high_ - low_ < 1e-9) high_ = low_ + 1.0;
  }
  double at(double value) const {
    return from_ + (to_ - from_) * (along(value) - low_) / (high_ - low_);
  }
  /// Values that get a line, with their name or, between named ones, none.
  std::vector<std::pair<double, std::string>> ticks() const {
    std::vector<std::pair<double, std::string>> all;
    if (!log_) {
      double step = std::pow(10.0, std::floor(std::log10(high_ - low_)));
      while ((high_ - low_) / step < 4) step /= (high_ - low_) / step < 2 ? 5 : 2;
      for (double v = std::ceil(low_ / step) * step; v <= high_; v += step)
        all.push_back({v, format("%.4g", std::abs(v) < 1e-9 * step ? 0.0 : v)});
      return all;
    }
    const bool few = high_ - low_ < 2.2;
    for (int decade = int(std::floor(low_)); decade <= int(std::ceil(high_)); ++decade)
      for (int k = 1; k < 10; ++k) {
        const double v = k * std::pow(10.0, decade);
        if (along(v) < low_ || along(v) > high_) continue;
        const bool named = k == 1 || (few && (k == 2 || k == 5));
        all.push_back({v, named ? format("%.4g", v) : std::string()});
      }
    return all;
  }

 private:
  double along(double value) const { return log_ ? std::log10(value) : value; }
  bool log_;
  double from_, to_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

/// A mark of the look at (x, y): circle, square, diamond, triangles, alternately filled.
std::string mark(int look, double x, double y, const std::string& tip) {
  const double r = kMark;
  std::string shape;
  switch (look % 4) {
    case 0:
      shape = format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%g\"", x, y, r);
      break;
    case 1:
      shape = format("<path d=\"M%.1f %.1fl%g %gl%g %gl%g %gz\"", x, y - 1.2 * r, 1.2 * r, 1.2 * r,
                     -1.2 * r, 1.2 * r, -1.2 * r, -1.2 * r);
      break;
    case 2:
      shape = format("<path d=\"M%.1f %.1fh%gv%gh%gz\"", x - 0.9 * r, y - 0.9 * r, 1.8 * r, 1.8 * r,
                     -1.8 * r);
      break;
    default:
      shape =
          format("<path d=\"M%.1f %.1fl%g %gh%gz\"", x, y - 1.1 * r, 1.2 * r, 2.0 * r, -2.4 * r);
  }
  return shape + format(" class=\"mark s%d%s\">", look, look / 4 % 2 == 1 ? " hollow" : "") +
         "<title>" + html::escaped(tip) + "</title>" + (look % 4 == 0 ? "</circle>" : "</path>");
}

const char* dashes(PlotSeries::Line line) {
  switch (line) {
    case PlotSeries::Line::dashed:
      return " dashed";
    case PlotSeries::Line::dotted:
      return " dotted";
    default:
      return "";
  }
}

class Drawing {
 public:
  explicit Drawing(const SvgPlot& plot)
      : plot_(plot),
        x_(plot.log_x && plot.x_words.empty(), kLeft, kWidth - kRight),
        y_(plot.log_y, kHeight - kBottom, kTop) {
    for (const PlotSeries& series : plot.series)
      for (const PlotPoint& point : series.points) {
        if (!x_.shows(point.x) || !y_.shows(point.y)) continue;
        x_.hold(point.x);
        y_.hold(point.y);
      }
    if (!plot.x_words.empty()) {
      x_.hold(-0.3);
      x_.hold(double(plot.x_words.size()) - 0.7);
    }
    x_.settle();
    y_.settle();
  }

  std::string body() {
    add("<title>" + html::escaped(plot_.title) + "</title>");
    text(kLeft, 18, "start", "title", plot_.title);
    add_axes();
    for (const PlotSeries& series : plot_.series) add_series(series);
    add_legend();
    return text_;
  }

 private:
  void add(const std::string& part) { text_ += part + "\n"; }
  void text(double x, double y, const char* anchor, const char* kind, const std::string& words) {
    add(format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" class=\"%s\">", x, y, anchor, kind) +
        html::escaped(words) + "</text>");
  }
  void line(const char* kind, double x1, double y1, double x2, double y2) {
    add(format("<line class=\"%s\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>", kind, x1, y1,
               x2, y2));
  }

  std::set<double> x_of_points() const {
    std::set<double> all;
    for (const PlotSeries& series : plot_.series)
      for (const PlotPoint& point : series.points)
        if (x_.shows(point.x)) all.insert(point.x);
    return all;
  }

  void add_axes() {
    const double bottom = kHeight - kBottom, right = kWidth - kRight;
    std::vector<std::pair<double, std::string>> ticks;
    for (std::size_t k = 0; k < plot_.x_words.size(); ++k)
      ticks.push_back({double(k), plot_.x_words[k]});
    if (plot_.x_at_points)
      for (const double x : x_of_points()) ticks.push_back({x, format("%.4g", x)});
    if (ticks.empty()) ticks = x_.ticks();
    double named = -kTickApart;
    for (const auto& [value, name] : ticks) {
      const double x = x_.at(value);
      line(name.empty() ? "grid fine" : "grid", x, kTop, x, bottom);
      if (name.empty() || x - named < kTickApart) continue;
      text(x, bottom + 17, "middle", "", name);
      named = x;
    }
    for (const auto& [value, name] : y_.ticks()) {
      const double y = y_.at(value);
      line(name.empty() ? "grid fine" : "grid", kLeft, y, right, y);
      if (!name.empty()) text(kLeft - 7, y + 4, "end", "", name);
    }
    text((kLeft + right) / 2, kHeight - 12, "middle", "axis", plot_.x_name);
    const double middle = (kTop + bottom) / 2;
    add(format("<text transform=\"translate(14 %.1f) rotate(-90)\" text-anchor=\"middle\" "
               "class=\"axis\">",
               middle) +
        html::escaped(plot_.y_name) + "</text>");
  }

  void add_series(const PlotSeries& series) {
    std::string path, marks;
    bool pen_down = false;
    double label_x = -kWidth, label_y = 0.0;
    for (const PlotPoint& point : series.points) {
      // A value that does not exist interrupts the line.
      if (!x_.shows(point.x) || !y_.shows(point.y)) {
        pen_down = false;
        continue;
      }
      const double x = x_.at(point.x), y = y_.at(point.y);
      path += format("%s%.1f %.1f", pen_down ? "L" : "M", x, y);
      pen_down = true;
      const std::string x_value =
          plot_.x_words.empty() ? format("%.3g", point.x) : plot_.x_words[std::size_t(point.x)];
      marks += mark(series.look, x, y,
                    series.name + (point.label.empty() ? "" : ", " + point.label) + ": " + x_value +
                        "; " + format("%.3g", point.y)) +
               "\n";
      if (point.label.empty() || std::hypot(x - label_x, y - label_y) < kLabelApart) continue;
      marks += format("<text x=\"%.1f\" y=\"%.1f\" class=\"label\">", x + 6, y - 5) +
               html::escaped(point.label) + "</text>\n";
      label_x = x;
      label_y = y;
    }
    if (series.line != PlotSeries::Line::none)
      add(format("<path class=\"line s%d%s\" d=\"", series.look, dashes(series.line)) + path +
          "\"/>");
    text_ += marks;
  }

  void add_legend() {
    const double x = kWidth - kRight + 16;
    double y = kTop + 8;
    for (const PlotSeries& series : plot_.series) {
      if (series.line != PlotSeries::Line::none)
        add(format("<path class=\"line s%d%s\" d=\"M%.1f %.1fh26\"/>", series.look,
                   dashes(series.line), x, y));
      add(mark(series.look, x + 13, y, series.name));
      text(x + 33, y + 4, "start", "", series.name);
      y += kLine;
    }
  }

  const SvgPlot& plot_;
  Axis x_, y_;
  std::string text_;
};

/// What depends on the reader's scheme. In plain values: not every reader of SVG knows variables.
std::string scheme(const char* ink, const char* faint, const char* grid, const char* paper,
                   const char* const* palette) {
  std::string css =
      format(".plot text{fill:%s}.plot .label{fill:%s}.plot .grid{stroke:%s}", ink, faint, grid);
  for (int look = 0; look < kLooks; ++look)
    css += format(".plot .line.s%d{stroke:%s}.plot .mark.s%d{fill:%s;stroke:%s}", look,
                  palette[look], look, palette[look], palette[look]);
  return css + format(".plot .mark.hollow{fill:%s}", paper);
}

}  // namespace

std::string svg_of(const SvgPlot& plot) {
  return format("<svg class=\"plot\" viewBox=\"0 0 %g %g\" role=\"img\">\n", kWidth, kHeight) +
         Drawing(plot).body() + "</svg>\n";
}

std::string svg_file_of(const SvgPlot& plot) {
  return format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" width=\"%g\" "
             "height=\"%g\" viewBox=\"0 0 %g %g\">\n<style>",
             kWidth, kHeight, kWidth, kHeight) +
         plot_style() + "</style>\n" + Drawing(plot).body() + "</svg>\n";
}

std::string plot_style() {
  return ".plot{font:13px system-ui,-apple-system,'Segoe UI',sans-serif}" +
         scheme("#24292f", "#6b7178", "#d8dce1", "#fff", kLight) +
         "@media (prefers-color-scheme:dark){" +
         scheme("#e4e6e9", "#9aa0a8", "#3d444d", "#17191c", kDark) + "}" +
         ".plot .title{font-size:15px;font-weight:600}.plot .label{font-size:11px}"
         ".plot .fine{opacity:.45}"
         ".plot .line{stroke-width:2;fill:none;stroke-linejoin:round}"
         ".plot .dashed{stroke-dasharray:7 4}.plot .dotted{stroke-dasharray:2 4}"
         ".plot .mark{stroke-width:1.5}";
}

}  // namespace drumhead::bench
