// SPDX-License-Identifier: MIT
// The page of a run: what stands in it, and how it behaves in a browser (Debian's package
// chromium-headless-shell; without it these tests are skipped).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "driver_scratch.h"
#include "image.h"
#include "page_plot.h"

namespace drumhead::driver {
namespace {

using Json = nlohmann::json;

constexpr int kWindowWidth = 1100, kWindowHeight = 2600;

TEST(DriverPagePlot, DrawsOneMarkAStepAndLeavesOutWhatALogarithmHasNot) {
  const std::string svg = svg_of(
      {.title = "a < b",
       .levels = {{"8²", {{1.0, "3"}, {0.0, ""}, {0.01, ""}}}, {"16²", {{NAN, ""}, {1e-5, ""}}}},
       .bound = 1e-3,
       .bound_name = "bound"});
  const auto count = [&](const std::string& part) {
    int n = 0;
    for (std::size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("<circle"), 3);
  EXPECT_EQ(count("class=\"line\""), 2);
  EXPECT_EQ(count("class=\"bound\" x1"), 1);
  EXPECT_EQ(count("a &lt; b"), 2);
  EXPECT_EQ(count("a < b"), 0);
  EXPECT_EQ(count("nan"), 0);
}

TEST(DriverPagePlot, AnEmptyRunIsAnEmptyPlot) {
  const std::string svg = svg_of({.title = "none"});
  EXPECT_EQ(svg.find("<circle"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

/// A page of a run, and scripts tried on it in a browser.
class DriverPage : public testing::Test {
 protected:
  DriverPage() {
    // A white square on black, which the warp carries 40 pixels to the right.
    Image photo{OIIO::ImageSpec(200, 160, 3, OIIO::TypeDesc::UINT8), {}};
    for (int k = 0; k < 200 * 160; ++k) {
      const int x = k % 200, y = k / 200;
      const bool white = x >= 60 && x < 100 && y >= 60 && y < 100;
      photo.pixels.insert(photo.pixels.end(), 3, white ? 1.0f : 0.0f);
    }
    write_image(photo, scratch / "photo.png");
    // A name that would break out of a careless page.
    const std::string name = "&lt;/script>&lt;img src='http://localhost:9/x.png'>&amp;";
    scratch.write("curves.svg", drawing(200, 160,
                                        "<g id='source'><path id=\"" + name +
                                            "\" d='M55 55 h50 v50 h-50 z'/></g>"
                                            "<g id='target' transform='translate(40)'><path id=\"" +
                                            name + "\" d='M55 55 h50 v50 h-50 z'/></g>"));
    result = run_drumhead(scratch, {"warp", "photo.png", "curves.svg", "--cells", "32", "--page",
                                    "page.html", "--report", "r.json"});
  }

  /// The browser's output for the page with `script` at its end.
  RunResult browse(const std::string& script, const std::vector<std::string>& flags) {
    std::string page = read_text(scratch / "page.html");
    const std::size_t end = page.rfind("</body>");
    page.insert(end, "<script>" + script + "</script>");
    scratch.write("tried.html", page);
    std::vector<std::string> words{
        "chromium-headless-shell",
        "--no-sandbox",
        "--disable-gpu",
        "--no-first-run",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-sync",
        "--hide-scrollbars",
        "--user-data-dir=" + (scratch / "browser").string(),
        "--window-size=" + std::to_string(kWindowWidth) + "," + std::to_string(kWindowHeight)};
    words.insert(words.end(), flags.begin(), flags.end());
    words.push_back("file://" + (scratch / "tried.html").string());
    return run_program(scratch, words);
  }

  /// The object that `expression` gives after the page has loaded.
  Json evaluate(const std::string& expression) {
    const RunResult shown = browse(
        "addEventListener('load', () => { const out = document.createElement('pre'); out.id = "
        "'probe'; out.textContent = JSON.stringify(" +
            expression + "); document.body.append(out); });",
        {"--dump-dom"});
    const std::string open = "<pre id=\"probe\">";
    const std::size_t from = shown.out.find(open);
    if (from == std::string::npos) return {};
    const std::size_t start = from + open.size();
    std::string text = shown.out.substr(start, shown.out.find("</pre>", start) - start);
    for (const auto& [reference, character] :
         {std::pair{"&lt;", "<"}, std::pair{"&gt;", ">"}, std::pair{"&amp;", "&"}}) {
      for (std::size_t at = 0; (at = text.find(reference, at)) != std::string::npos; ++at) {
        text.replace(at, std::string(reference).size(), character);
      }
    }
    return Json::parse(text);
  }

  /// Green of the page at row 70 of the compared pictures, by column (0…200), with the slider
  /// moved.
  std::function<float(double)> seen(double slider) {
    const Json box = evaluate(
        "(r => [r.left, r.top, r.width])(document.getElementById('compare')."
        "getBoundingClientRect())");
    browse("slider.value = " + std::to_string(slider) +
               "; slider.dispatchEvent(new Event('input', {bubbles: true}));",
           {"--screenshot=" + (scratch / "page.png").string()});
    const Image page = read_image(scratch / "page.png");
    const double scale = box.at(2).get<double>() / 200;
    const auto row = std::size_t(box.at(1).get<double>() + 70 * scale);
    return [=](double x) {
      const auto column = std::size_t(box.at(0).get<double>() + x * scale);
      return page
          .pixels[(row * std::size_t(page.width()) + column) * std::size_t(page.channels()) + 1];
    };
  }

  bool no_browser() const {
    return run_program(scratch, {"chromium-headless-shell", "--version"}).exit_code == 127;
  }

  Scratch scratch;
  RunResult result;
};

#define SKIP_WITHOUT_BROWSER() \
  if (no_browser()) GTEST_SKIP() << "chromium-headless-shell is not installed"

TEST_F(DriverPage, HoldsTheReportAndNothingFromElsewhere) {
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string page = read_text(scratch / "page.html");
  EXPECT_EQ(page.find("{{"), std::string::npos);
  for (const char* outside : {"src=\"http", "href=", "<img src='http", "url(", "@import"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  const std::string open = "<script type=\"application/json\" id=\"report\">";
  const std::size_t start = page.find(open) + open.size();
  const Json held = Json::parse(page.substr(start, page.find("</script>", start) - start));
  EXPECT_EQ(held, Json::parse(read_text(scratch / "r.json")));
}

TEST_F(DriverPage, ShowsItsPicturesPlotsAndTablesInABrowser) {
  SKIP_WITHOUT_BROWSER();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json page = evaluate(
      "({images: [...document.images].map(i => [i.id, i.complete && i.naturalWidth]),"
      " loads: performance.getEntriesByType('resource').map(e => e.name)"
      ".filter(n => !n.startsWith('data:')),"
      " status: document.querySelector('.status').textContent,"
      " marks: document.querySelectorAll('svg circle').length,"
      " name: document.querySelector('#curves tbody td').textContent,"
      " rows: document.querySelectorAll('#curves tbody tr').length,"
      " wide: document.documentElement.scrollWidth <= innerWidth})");
  const Json report = Json::parse(read_text(scratch / "r.json"));
  EXPECT_EQ(page["images"], Json::parse(R"([["after", 1000], ["before", 1000], ["overlay", 1000],
                            ["jacobian", 1000]])"));
  EXPECT_EQ(page["loads"], Json::array());
  EXPECT_EQ(page["status"], "converged");
  std::size_t steps = 0;
  for (const Json& level : report["levels"]) steps += level["newton"].size();
  EXPECT_EQ(page["marks"], 2 * steps);
  EXPECT_EQ(page["name"], report["curves"][0]["name"]);
  EXPECT_EQ(page["rows"], 1);
  EXPECT_EQ(page["wide"], true);
}

TEST_F(DriverPage, TheSliderUncoversThePictureAsItWas) {
  SKIP_WITHOUT_BROWSER();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // The square was at x = 80, and is at 120.
  const auto before = seen(100);
  EXPECT_GT(before(75), 0.9f);
  EXPECT_LT(before(125), 0.1f);
  const auto after = seen(0);
  EXPECT_LT(after(75), 0.1f);
  EXPECT_GT(after(125), 0.9f);
  const auto both = seen(50);
  EXPECT_GT(both(75), 0.9f);
  EXPECT_GT(both(125), 0.9f);
}

}  // namespace
}  // namespace drumhead::driver
