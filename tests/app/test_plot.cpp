// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim plot, with gnuplot, as a user runs it.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"
#include "support/svg_texts.hpp"

namespace bbsim_test::test_plot {

using Catch::Matchers::Contains;

namespace {

// Why a text is not XML, among the faults that a picture can have; empty if it is.
std::string fault_of_xml(const std::string& text) {
  std::vector<std::string> open;
  std::size_t at = text.find("<svg");
  if (at == std::string::npos) return "no svg";
  while (at < text.size()) {
    const std::size_t tag = text.find('<', at);
    const std::string words = text.substr(at, tag - at);
    if (words.find("]]>") != std::string::npos) return "]]> in a text";
    for (std::size_t i = words.find('&'); i != std::string::npos; i = words.find('&', i + 1)) {
      const std::string entity = words.substr(i, words.find(';', i) - i + 1);
      if (entity != "&amp;" && entity != "&lt;" && entity != "&gt;" && entity != "&quot;" &&
          !entity.starts_with("&#")) {
        return "the entity " + entity;
      }
    }
    if (std::ranges::any_of(words, [](unsigned char c) {
          return c < ' ' && c != '\n' && c != '\t' && c != '\r';
        })) {
      return "a control character";
    }
    if (tag == std::string::npos) break;
    if (text.compare(tag, 4, "<!--") == 0) {
      at = text.find("-->", tag) + 3;
      continue;
    }
    const std::size_t end = text.find('>', tag);
    if (end == std::string::npos) return "a tag that is not closed";
    at = end + 1;
    if (text[tag + 1] == '/') {
      if (open.empty() || open.back() != text.substr(tag + 2, end - tag - 2)) {
        return "the end of a tag that was not begun";
      }
      open.pop_back();
    } else if (text[end - 1] != '/') {
      open.push_back(text.substr(tag + 1, text.find_first_of(" \t\n>", tag) - tag - 1));
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> stays open";
}

bool is_png(const std::string& bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1a\n") && bytes.find("IEND") != std::string::npos &&
         bytes.size() > 5000;
}

bool is_pdf(const std::string& bytes) {
  return bytes.starts_with("%PDF-") && bytes.find("%%EOF") != std::string::npos;
}

std::vector<std::string> scenarios_of(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void draw_all_of(const std::string& configs, const std::string& ending) {
  const Folder folder;
  const std::vector<std::string> scenarios = scenarios_of(configs);
  REQUIRE(scenarios.size() > 10);
  for (const std::string& scenario : scenarios) {
    const std::string name = std::filesystem::path(scenario).stem();
    CAPTURE(name);
    REQUIRE(bbsim({"run", scenario, "-o", folder / (name + ending), "-q"}).exit_code <= 1);
    for (const std::string format : {"svg", "png", "pdf"}) {
      const Result drawn = bbsim({"plot", name + ending, "--format", format}, folder.path());
      REQUIRE(drawn.err == name + "." + format + drawn.err.substr(drawn.err.find(':')));
      CHECK_THAT(drawn.err, Contains(" panels\n"));
      CHECK(drawn.out.empty());
      REQUIRE(drawn.exit_code == 0);
    }
    const std::string svg = folder.read(name + ".svg");
    CHECK(fault_of_xml(svg).empty());
    CHECK(svg.find("<path") != std::string::npos);
    CHECK(collisions_in(svg) == "");
    CHECK(is_png(folder.read(name + ".png")));
    CHECK(is_pdf(folder.read(name + ".pdf")));
  }
}

std::string fault(std::vector<std::string> arguments, const Folder& folder) {
  arguments.insert(arguments.begin(), "plot");
  const Result result = bbsim(std::move(arguments), folder.path());
  CHECK(result.exit_code == 2);
  CHECK(result.out.empty());
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  return result.err;
}

}  // namespace

TEST_CASE("every scenario's run is drawn, in every format, from HDF5", "[slow]") {
  draw_all_of(config(""), ".h5");
}

TEST_CASE("every hard scenario's run is drawn, in every format, from CSV") {
  draw_all_of(config("hard"), ".csv");
}

TEST_CASE("a run's picture shows its scene: title, plate, events, friction") {
  const Folder folder;
  REQUIRE(bbsim({"run", config("slips.yaml"), "-o", folder / "slips.h5"}).exit_code == 1);
  REQUIRE(bbsim({"plot", folder / "slips.h5"}).exit_code == 0);
  const std::string from_hdf5 = folder.read("slips.svg");
  for (const char* text : {"A plate that rocks too fast for the friction",
                           "slips.h5, stopped at t = 0.556624 s: lift_off", "slip, 2 times",
                           "lift_off (stops)", "coefficient 0.1", "friction demand"}) {
    CAPTURE(text);
    CHECK_THAT(from_hdf5, Contains(text));
  }

  // A CSV lacks these data: they come from its summary ...
  REQUIRE(bbsim({"run", config("falls.yaml"), "-o", folder / "falls.csv"}).exit_code == 1);
  REQUIRE(bbsim({"plot", folder / "falls.csv"}).exit_code == 0);
  CHECK_THAT(folder.read("falls.svg"), !Contains("plate's edge"));
  REQUIRE(bbsim({"run", config("falls.yaml"), "-o", folder / "falls.csv", "--summary",
                 folder / "falls.json"})
              .exit_code == 1);
  REQUIRE(bbsim({"plot", folder / "falls.csv"}).exit_code == 0);
  CHECK_THAT(folder.read("falls.svg"), Contains("plate's edge") && Contains("edge (stops)") &&
                                           Contains("A catch that comes too late"));
  // ... or from the scenario.
  std::filesystem::remove(folder / "falls.json");
  REQUIRE(bbsim({"plot", folder / "falls.csv", "--scenario", config("falls.yaml"), "--set",
                 "events.slip.friction=0.2"})
              .exit_code == 0);
  CHECK_THAT(folder.read("falls.svg"), Contains("plate's edge") && Contains("coefficient 0.2"));
}

TEST_CASE("the summary carries the scenario's text") {
  const Folder folder;
  REQUIRE(
      bbsim({"run", config("incline.yaml"), "-o", folder / "a.csv", "--summary", folder / "a.json"})
          .exit_code == 0);
  const auto summary = nlohmann::json::parse(folder.read("a.json"));
  CHECK_THAT(summary.at("scenario_text").get<std::string>(),
             Contains("title: A ball let go on a fixed incline\n"));
}

TEST_CASE("runs are compared in one picture, with chosen columns, standard input and output") {
  const Folder folder;
  for (const std::string k : {"0.5", "2"}) {
    REQUIRE(bbsim({"run", config("hold.yaml"), "--set",
                   "controller.pd.kp=[[" + k + ", 0], [0, -" + k + "]]", "-o",
                   folder / ("hold-" + k + ".csv")})
                .exit_code == 0);
  }
  const Result both = bbsim({"plot", "--overlay", "hold-0.5.csv", "hold-2.csv"}, folder.path());
  REQUIRE(both.exit_code == 0);
  CHECK(collisions_in(folder.read("hold-0.5-overlay.svg")) == "");
  CHECK_THAT(both.err, Contains("hold-0.5-overlay.svg: 1002 rows"));
  CHECK_THAT(folder.read("hold-0.5-overlay.svg"),
             Contains("hold-0.5.csv") && Contains("hold-2.csv"));
  const Result chosen = bbsim({"plot", folder / "hold-2.csv", "--columns", "path;x,x_reference",
                               "--columns", "torque_phi", "-o", "-"});
  REQUIRE(chosen.exit_code == 0);
  CHECK(fault_of_xml(chosen.out).empty());
  CHECK_THAT(chosen.out, Contains("torque φ (mN m)") && Contains("y (cm)") && !Contains("γ"));
  CHECK(chosen.err.empty());
  CHECK(bbsim({"-q", "plot", folder / "hold-2.csv"}).err.empty());
  const Result two = bbsim({"plot", "hold-0.5.csv", "hold-2.csv"}, folder.path());
  CHECK_THAT(two.err, Contains("hold-0.5.svg: ") && Contains("hold-2.svg: "));
}

TEST_CASE("a log in its own units is labelled without units, and its gaps stay gaps") {
  const Folder folder;
  folder.write("log.csv", "t,x,y,phi\n0,-12,3,2\n0.1,-11,2,2\n0.2,,,\n0.3,-9,1,1\n0.4,-8,0,1\n");
  REQUIRE(bbsim({"plot", "log.csv"}, folder.path()).exit_code == 0);
  const std::string svg = folder.read("log.svg");
  for (const char* unit : {"(m)", "(cm)", "(s)", "(°)", "(SI)"}) CHECK_THAT(svg, !Contains(unit));
  for (const char* name : {">x<", ">y<", ">x, y<", ">φ<", ">t<"}) CHECK_THAT(svg, Contains(name));
  // The path's line, after its sample in the legend, has two pieces: the pen moves twice.
  const std::string stroke = "<path stroke='rgb(  0, 114, 178)'  d='";
  const std::size_t start = svg.find(stroke, svg.find(stroke) + 1) + stroke.size();
  const std::string line = svg.substr(start, svg.find('\'', start) - start);
  CHECK(std::count(line.begin(), line.end(), 'M') == 2);
}

TEST_CASE("sweeps are drawn: lines, maps and histograms, from CSV and HDF5") {
  const Folder folder;
  const auto sweep = [&](std::vector<std::string> vary, const std::string& name) {
    std::vector<std::string> words = {"sweep", config("fig2b.yaml"), "-o", folder / name, "-q"};
    words.insert(words.end(), vary.begin(), vary.end());
    REQUIRE(bbsim(words).exit_code == 0);
    const std::string picture = folder / (name + ".svg");
    REQUIRE(bbsim({"plot", folder / name, "-o", picture}).exit_code == 0);
    const std::string svg = folder.read(name + ".svg");
    CHECK(fault_of_xml(svg).empty());
    CHECK(collisions_in(svg) == "");
    return svg;
  };
  const std::string kv = "controller.pd.kv.0.0=linear:-1:1:9";
  CHECK_THAT(sweep({"--vary", kv}, "lines.csv"),
             Contains("failed: ") && Contains("rms_tracking_error") &&
                 Contains("controller.pd.kv.0.0") && !Contains("(SI)"));
  CHECK_THAT(sweep({"--vary", kv, "--vary", "controller.pd.kp.0.0=log:0.001:1:7"}, "map.h5"),
             Contains("controller.pd.kp.0.0") && !Contains("(SI)") && Contains("map.h5, 63 cases"));
  CHECK_THAT(sweep({"--vary", "ball.position.0=normal:5 cm:2 mm", "--samples", "40"}, "draws.h5"),
             Contains("median ") && Contains("95 %: "));
  CHECK_THAT(sweep({"--vary", kv, "--vary", "ball.position.0=normal:5 cm:2 mm", "--samples", "5"},
                   "band.h5"),
             Contains("over draws of ball.position.0"));
}

TEST_CASE("hostile names and titles are shown as text") {
  const Folder folder;
  const std::string scene =
      folder.write("scene.yaml",
                   "title: \"a 'quote' ''two'' \\\"double\\\" @home `id` {_sub} ^sup \\\\n $(id) "
                   "<b>&amp; ]]> %d\"\n"
                   "ball: {radius: 0.01, position: [0.1, 0]}\ngimbal: {motion: {phi: 0.01}}\n"
                   "time: {end: 1, step: 0.1}\n");
  const std::string name = "it's\n@a_{b}^c `id` $(id) \"q\" ''\xff";
  REQUIRE(bbsim({"run", scene, "-o", folder / (name + ".h5")}).exit_code == 0);
  for (const std::string format : {"svg", "png", "pdf"}) {
    CAPTURE(format);
    REQUIRE(bbsim({"plot", folder / (name + ".h5"), "--format", format}).exit_code == 0);
  }
  const std::string svg = folder.read(name + ".svg");
  CHECK(fault_of_xml(svg).empty());
  CHECK_THAT(svg, Contains("a 'quote' ''two'' \"double\" @home `id` {_sub} ^sup \\n $(id) "
                           "&lt;b>&amp;amp; ]]&gt; %d"));
  CHECK_THAT(svg, Contains("it's @a_{b}^c `id` $(id) \"q\" ''�.h5"));
  CHECK(is_png(folder.read(name + ".png")));
}

TEST_CASE("what cannot be drawn is reported in one line") {
  const Folder folder;
  folder.write("run.csv", "t,x,y,phi\n0,1,2,3\n1,2,3,4\n");
  folder.write("beam.csv", "t,x\n0,1\n1,2\n");
  folder.write("empty.csv", "");
  folder.write("sweep.csv", "case,ball.radius,status,end_time,end_x\n0,1,done,1,1\n1,2,done,1,2\n");
  CHECK_THAT(fault({"none.csv"}, folder), Contains("cannot read none.csv: no such file"));
  CHECK_THAT(fault({"empty.csv"}, folder), Contains("empty.csv:1:1: found no header"));
  CHECK_THAT(fault({"none.h5"}, folder), Contains("none.h5"));
  CHECK_THAT(fault({config("rig.yaml")}, folder), Contains("is a scenario"));
  CHECK_THAT(fault({"run.csv", "-o", "a.gif"}, folder), Contains(".svg, .png or .pdf"));
  CHECK_THAT(fault({"run.csv", "--format", "gif"}, folder), Contains("svg, png and pdf"));
  CHECK_THAT(fault({"run.csv", "beam.csv", "-o", "a.svg"}, folder), Contains("--overlay"));
  CHECK_THAT(fault({"run.csv", "--columns", "phii"}, folder), Contains("did you mean phi?"));
  CHECK_THAT(fault({"beam.csv", "--columns", "path"}, folder), Contains("no numbers x and y"));
  CHECK_THAT(fault({"run.csv", "--over", "x"}, folder), Contains("is not a sweep"));
  CHECK_THAT(fault({"sweep.csv", "run.csv", "--overlay"}, folder), Contains("a sweep has"));
  CHECK_THAT(fault({"sweep.csv", "--columns", "y"}, folder), Contains("measures of sweep.csv"));
  CHECK_THAT(fault({"-"}, folder), Contains("--output: missing"));
  CHECK_THAT(fault({"run.csv", "--set", "gravity=9"}, folder), Contains("--scenario"));
  CHECK_THAT(fault({"/dev/zero", "-o", "a.svg"}, folder), Contains("more than 1048576 bytes"));

  // No picture overwrites an input or another picture.
  folder.write("run.svg", "t,x\n0,1\n1,2\n");
  CHECK_THAT(fault({"run.csv", "run.svg"}, folder),
             Contains("it is the same file as run.svg (what is drawn)"));
  CHECK_THAT(fault({"run.csv", "-o", "run.csv", "--format", "svg"}, folder),
             Contains("it is the same file as run.csv (what is drawn)"));
  std::filesystem::create_symlink("run.csv", folder / "link.png");
  CHECK_THAT(fault({"run.csv", "-o", "link.png"}, folder),
             Contains("it is the same file as run.csv (what is drawn)"));
  std::filesystem::remove(folder / "run.svg");
  CHECK_THAT(fault({"run.csv", "./run.csv"}, folder), Contains("which is written here, too"));

  // Other files are still drawn.
  CHECK_THAT(bbsim({"plot", "none.csv", "beam.csv"}, folder.path()).err,
             Contains("beam.svg: 2 rows") && Contains("cannot read none.csv"));
}

TEST_CASE("a picture that cannot be written, or that lacks gnuplot, gives exit code 3") {
  const Folder folder;
  const std::string csv = folder.write("run.csv", "t,x\n0,1\n1,2\n");
  CHECK(bbsim({"plot", csv, "-o", folder / "none/a.svg"}).exit_code == 3);
  const char* const path = std::getenv("PATH");
  const std::string before = path != nullptr ? path : "";
  setenv("PATH", "/nowhere", 1);
  const Result without = bbsim({"plot", csv});
  setenv("PATH", before.c_str(), 1);
  CHECK(without.exit_code == 3);
  CHECK_THAT(without.err, Contains("apt install gnuplot-nox"));
  CHECK(folder.files() == std::vector<std::string>{"run.csv"});
}

TEST_CASE("a user's gnuplot settings have no effect") {
  const Folder folder;
  folder.write("run.csv", "t,x\n0,1\n1,2\n");
  folder.write(".gnuplot", "set terminal png\nset output 'elsewhere.png'\n");
  const char* const home = std::getenv("HOME");
  const std::string before = home != nullptr ? home : "";
  setenv("HOME", folder.path().c_str(), 1);
  const Result drawn = bbsim({"plot", "run.csv"}, folder.path());
  setenv("HOME", before.c_str(), 1);
  CHECK(drawn.exit_code == 0);
  CHECK(fault_of_xml(folder.read("run.svg")).empty());
  CHECK(folder.files() == std::vector<std::string>{".gnuplot", "run.csv", "run.svg"});
}

}  // namespace bbsim_test::test_plot
