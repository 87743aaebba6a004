// SPDX-License-Identifier: MIT
// The page of the measurements: bench/report on small files of rows, as a program.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace drumhead {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

const char* kRows = R"({
 "program": "speed_bench", "command": "speed_bench table1", "date": "2026-01-02T03:04:05Z",
 "commit": "abc1234", "compiler": "GNU 12.2.0", "processor": "Some <processor>", "processors": 2,
 "load": 0.25,
 "rows": [
  {"table":"table1","scene":"S1","kappa":1.0,"method":"drumhead, averaged","n":50,"threads":1,
   "status":"converged","seconds":0.002,"bytes":190000,"bytes_per_node":73.0},
  {"table":"table1","scene":"S1","kappa":1.0,"method":"drumhead, averaged","n":100,"threads":1,
   "status":"converged","seconds":0.004,"bytes":670000,"bytes_per_node":66.0},
  {"table":"table1","scene":"S1","kappa":1.0,"method":"drumhead, averaged","n":100,"threads":2,
   "status":"converged","seconds":0.005,"bytes":680000,"bytes_per_node":67.0},
  {"table":"warps","scene":"S4","kappa":1.0,"method":"drumhead, conforming","n":250,
   "seconds":0.02,"gap_rms_px":0.03,"folded_share":0.004,"rms_J":0.3},
  {"table":"warps","scene":"S4","method":"spline","points":148,"n":250,
   "seconds":0.06,"gap_rms_px":0.01,"folded_share":0.0,"rms_J":0.5},
  {"table":"warps","scene":"S4","method":"spline","points":36,"n":250,
   "seconds":0.05,"gap_rms_px":0.2,"folded_share":0.0,"rms_J":0.5},
  {"table":"work_precision","scene":"S2","kappa":1.0,"method":"drumhead, averaged","n":50,
   "status":"converged","seconds":0.1,"rms_px":4.0,"max_px":9.0,"folded":155},
  {"table":"mesh","scene":"S2","kappa":1.0,"method":"Mesh","n":50,
   "status":"converged","seconds":0.3,"rms_px":1.0,"max_px":7.0,"folded":14},
  {"table":"amg","scene":"S2","kappa":1.0,"method":"Same equations","n":50,
   "status":"converged","seconds":0.3,"rms_px":3.8,"max_px":8.5},
  {"table":"direct","scene":"S1","kappa":1.0,"method":"Rival","n":100,"threads":1,
   "seconds":0.001,"bytes":25000000,"bytes_per_node":2450.0,"rms_px":null},
  {"table":"rates","scene":"S2","kappa":"inf","n":128,"solver":"gcr","work_units_per_digit":273.4,
   "cycles":16,"converged":true},
  {"table":"rates","scene":"S2","kappa":"inf","n":128,"solver":"kaczmarz",
   "work_units_per_digit":null,"cycles":2,"converged":false},
  {"table":"solve","scene":"S5","kappa":7.0,"n":100,"status":"limit","seconds":1.5},
  {"table":"solve","scene":"S2","kappa":10.0,"curves":"averaged","n":800,"status":"converged",
   "work_units":92.0,"work_units_least":88.0,"work_units_most":96.5,"newton":2.5,"cycles":3.0,
   "true_share":0.05,"true_share_most":0.07}
 ]})";

class BenchReport : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("drumhead_report_" + std::to_string(std::rand()) +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_ / "plots");
    write("rows.json", kRows);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  std::string read(const std::string& name) {
    std::ifstream stream(folder_ / name);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// Exit code of the program run in the folder; what it prints is in "out" and "err".
  int report(const std::string& arguments) {
    const std::string command =
        "cd '" + folder_.string() + "' && '" DRUMHEAD_REPORT "' " + arguments + " >out 2>err";
    return WEXITSTATUS(std::system(command.c_str()));
  }
  static bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }

  fs::path folder_;
};

TEST_F(BenchReport, makes_one_page_with_tables_plots_and_what_is_lost) {
  ASSERT_EQ(report("-o page.html --plots plots rows.json"), 0) << read("err");
  const std::string page = read("page.html");
  EXPECT_TRUE(holds(page, "<td>drumhead, averaged, 1 thread</td>"));
  EXPECT_TRUE(holds(page, "<td class=\"number\">0.004</td>"));
  EXPECT_TRUE(holds(page, "<title>drumhead, averaged, 1 thread: 100; 0.004</title>"));
  EXPECT_TRUE(holds(page, "speed_bench table1</td><td>2026-01-02T03:04:05Z</td><td>abc1234</td>"));
  EXPECT_TRUE(holds(page, "Not measured yet."));
  EXPECT_FALSE(holds(page, "{{"));
  EXPECT_FALSE(holds(page, "://"));
  EXPECT_TRUE(holds(read("plots/speed.svg"), "<svg xmlns=\"http://www.w3.org/2000/svg\""));
}

TEST_F(BenchReport, says_in_words_where_drumhead_loses) {
  ASSERT_EQ(report("-o page.html rows.json"), 0) << read("err");
  const std::string page = read("page.html");
  for (const char* words :
       {"<li>Rival takes 0.001 s at 100², 1 thread; drumhead, averaged 0.004 s.",
        "<li>drumhead, averaged, 100²: 2 threads are 0.8 times as fast as one.",
        "<li>S2 kappa 1: Mesh at 50² reaches 1 px in 0.3 s; drumhead does not on the lattices "
        "tried "
        "(its best: 4 px).",
        "<li>S2 kappa 1, 50²: Mesh 1 (7); drumhead, averaged 4 (9).",
        "<li>S2 kappa 1, 50²: Mesh 14; drumhead, averaged 155.",
        "<li>S4: spline meets the curves more closely, px RMS: 0.01 (148 points); drumhead, "
        "conforming at kappa 1 0.03.",
        "<li>S4: spline folds less of the picture, %: 0 (148 points), 0 (36 points); drumhead, "
        "conforming at kappa 1 0.4.",
        "<li>solve: S5 kappa 7: limit at 100²."})
    EXPECT_TRUE(holds(page, words)) << words;
  EXPECT_FALSE(holds(page, "50²: Same equations"));  // within a tenth
  EXPECT_FALSE(holds(page, "spline is faster"));
}

TEST_F(BenchReport, keeps_text_apart_from_markup) {
  ASSERT_EQ(report("-o page.html rows.json"), 0) << read("err");
  EXPECT_TRUE(holds(read("page.html"), "Some &lt;processor&gt;"));
  EXPECT_FALSE(holds(read("page.html"), "Some <processor>"));
}

TEST_F(BenchReport, prints_the_same_numbers_as_markdown) {
  ASSERT_EQ(report("--markdown rows.json"), 0) << read("err");
  const std::string tables = read("out");
  EXPECT_TRUE(holds(tables, "| drumhead, averaged, 1 thread | 0.002 | 0.004 |"));
  EXPECT_TRUE(holds(tables, "| 128² S2, kappa ∞ | 273 (16) | –* (2) |"));
}

TEST_F(BenchReport, shows_the_range_of_a_mean) {
  ASSERT_EQ(report("--markdown rows.json"), 0) << read("err");
  const std::string tables = read("out");
  EXPECT_TRUE(holds(tables, "| S2, kappa 10 | averaged | 800² | converged | 92 (88–96.5) |"));
  EXPECT_TRUE(holds(tables, "| 0.05 (≤ 0.07) |"));
}

TEST_F(BenchReport, makes_the_tables_of_a_readme_anew_and_leaves_the_rest) {
  write(
      "README.md",
      "before\n<!-- table table1, made by bench/report.sh -->\nold\n<!-- end of table table1 -->\n"
      "after\n");
  ASSERT_EQ(report("--readme README.md rows.json"), 0) << read("err");
  const std::string readme = read("README.md");
  EXPECT_TRUE(holds(readme, "before\n<!-- table table1, made by bench/report.sh -->\n| seconds"));
  EXPECT_TRUE(holds(readme, "| drumhead, averaged, 1 thread | 0.002 (0.19) | 0.004 (0.67) |"))
      << readme;
  EXPECT_TRUE(holds(readme, "Commit abc1234"));
  EXPECT_TRUE(readme.ends_with("<!-- end of table table1 -->\nafter\n"));
  EXPECT_FALSE(holds(readme, "old"));
}

TEST_F(BenchReport, refuses_a_readme_whose_marks_are_wrong) {
  const std::string open = "<!-- table table1, made by bench/report.sh -->\n";
  for (const std::string& text :
       {open + "no end\n",
        "<!-- table other, made by bench/report.sh -->\n<!-- end of table other -->\n"s}) {
    write("README.md", text);
    EXPECT_EQ(report("--readme README.md rows.json"), 2);
    EXPECT_TRUE(holds(read("err"), "README: ")) << read("err");
    EXPECT_EQ(read("README.md"), text);
  }
}

TEST_F(BenchReport, holds_the_pictures_of_a_folder) {
  fs::create_directories(folder_ / "pictures");
  write("pictures/face-after.png", "abc");
  write("pictures/face-before.png", "ab");
  ASSERT_EQ(report("-o page.html --pictures pictures rows.json"), 0) << read("err");
  const std::string page = read("page.html");
  const std::size_t before = page.find("data:image/png;base64,YWI=");
  const std::size_t after = page.find("data:image/png;base64,YWJj");
  ASSERT_NE(after, std::string::npos);
  EXPECT_LT(before, after);
}

TEST_F(BenchReport, refuses_what_is_not_a_document_of_rows_and_names_the_file) {
  const std::pair<const char*, const char*> wrong[] = {
      {"cut.json", "{\"program\": \"x\", \"rows\": ["},
      {"empty.json", ""},
      {"headless.json", "{\"rows\": []}"},
      {"rowless.json", R"({"program":"","command":"","date":"","commit":"","compiler":"",
                           "processor":"","processors":1,"rows":[{"scene":"S1"}]})"}};
  for (const auto& [name, text] : wrong) {
    write(name, text);
    EXPECT_EQ(report(std::string("-o page.html rows.json ") + name), 2) << name;
    EXPECT_TRUE(holds(read("err"), std::string("report: ") + name)) << read("err");
  }
  EXPECT_EQ(report("-o page.html missing.json"), 2);
  EXPECT_TRUE(holds(read("err"), "report: missing.json: cannot be read"));
  EXPECT_FALSE(fs::exists(folder_ / "page.html"));
}

TEST_F(BenchReport, refuses_arguments_that_it_does_not_know) {
  for (const char* arguments : {"", "rows.json", "-o", "-o page.html",
                                "--markdown -o page.html "
                                "rows.json",
                                "--marks rows.json"})
    EXPECT_EQ(report(arguments), 2) << arguments;
  EXPECT_FALSE(fs::exists(folder_ / "page.html"));
}

}  // namespace
}  // namespace drumhead
