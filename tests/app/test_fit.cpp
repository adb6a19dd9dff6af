// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim fit --report as a user runs it. The page's display is tested in a browser
// (tests/replay/browser).
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_fit {

using Catch::Matchers::Contains;

namespace {

// A fit of a log that bbsim makes, with optional extra arguments.
class Fit {
 public:
  Fit() {
    const Result made =
        bbsim({"run", config("recorded.yaml"), "--set", "ball.inertia_factor=0.6", "--set",
               "time.step=0.02", "--set", "output.columns=[t,x,y]", "-o", "log.csv", "-q"},
              folder.path());
    REQUIRE(made.exit_code == 0);
  }

  [[nodiscard]] Launch launch(const std::vector<std::string>& more) const {
    Launch launch{
        {"fit", config("recorded.yaml"), "log.csv", "--free", "ball.inertia_factor", "-q"},
        folder.path()};
    launch.arguments.insert(launch.arguments.end(), more.begin(), more.end());
    return launch;
  }

  Folder folder;
};

}  // namespace

TEST_CASE("fit --report writes a self-contained page") {
  const Fit fit;
  const Result made = bbsim(fit.launch({"--report", "fit.html", "--json", "fit.json"}));
  INFO(made.err);
  REQUIRE(made.exit_code == 0);
  CHECK_THAT(made.out, Contains("ball.inertia_factor"));
  const std::string page = fit.folder.read("fit.html");
  CHECK_THAT(page, Contains("<title>Fit of A recorded motion, with a drift added</title>"));
  for (const char* const request :
       {"<script src", "stylesheet", "src=\"http", "href=\"http", "@import", "url(http"}) {
    CAPTURE(request);
    CHECK(page.find(request) == std::string::npos);
  }
  CHECK_THAT(page, Contains("content=\"default-src 'none'; script-src 'unsafe-inline'"));
  const std::string begin = "<script type=\"application/json\" id=\"bbsim-data\">";
  const std::size_t from = page.find(begin) + begin.size();
  const auto data = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  const auto json = nlohmann::json::parse(fit.folder.read("fit.json"));
  CHECK_THAT(data["version"].get<std::string>(), Catch::Matchers::StartsWith(BBSIM_VERSION));
  CHECK(data["runs"][0]["rows"] == 201);
  // bbsim wrote the log, so all digits are known.
  const std::string estimate = data["parameters"]["rows"][0][2];
  CHECK(std::stod(estimate) ==
        Approx(json["parameters"][0]["estimate"].get<double>()).epsilon(1e-5));

  const Result alone = bbsim(fit.launch({"--report", "-"}));
  CHECK(alone.exit_code == 0);
  CHECK(alone.out == page);
}

TEST_CASE("fit --report leaves a complete page or none") {
  const Fit fit;
  struct Fault {
    std::vector<std::string> words;
    int exit_code;
    std::string message;
  };
  for (const Fault& fault : {
           Fault{{"--report", "/dev/full"}, 3, "/dev/full"},
           Fault{{"--report", "none/fit.html"}, 3, "none/fit.html"},
           Fault{{"--report", "log.csv"}, 2, "the log"},
           Fault{{"--report", config("recorded.yaml")}, 2, "the scenario"},
           Fault{{"--report", "one", "-o", "./one"}, 2, "--report"},
           Fault{{"--report", "one", "--json", "one"}, 2, "--report"},
           Fault{{"--report", "-", "--json", "-"}, 2, "--report"},
       }) {
    CAPTURE(fault.words);
    const Result made = bbsim(fit.launch(fault.words));
    CHECK(made.exit_code == fault.exit_code);
    CHECK(made.out.empty());
    CHECK_THAT(made.err, Contains(fault.message));
  }
  SECTION("a missing template is reported before the fit") {
    Launch launch = fit.launch({"--report", "fit.html", "--json", "fit.json"});
    launch.prepare = [] { setenv("BBSIM_SHARE_PATH", "/nowhere", 1); };
    const Result made = bbsim(launch);
    CHECK(made.exit_code == 3);
    CHECK_THAT(made.err, Contains("fit.html is not in /nowhere") && Contains("libjs-dygraphs"));
  }
  SECTION("the template cannot be the output page") {
    const std::string page = "<title>@BBSIM_TITLE@</title>@BBSIM_DATA@";
    fit.folder.write("fit.html", page);
    Launch launch = fit.launch({"--report", "fit.html"});
    launch.prepare = [] { setenv("BBSIM_SHARE_PATH", ".", 1); };
    const Result made = bbsim(launch);
    CHECK(made.exit_code == 2);
    CHECK_THAT(made.err, Contains("fit.html (the template of pages), which is read here"));
    CHECK(fit.folder.read("fit.html") == page);
    return;
  }
  CHECK(fit.folder.files() == std::vector<std::string>{"log.csv"});
}

}  // namespace bbsim_test::test_fit
