// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim compare on the program's own results: runs and sweeps, CSV and HDF5.
#include <cstdlib>
#include <string>
#include <vector>

#include "catch.hpp"
#include "shell.hpp"

namespace bbsim_test::test_compare {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::vector<std::string> sweep_words{"sweep",
                                           config("fig2b.yaml"),
                                           "-q",
                                           "--vary",
                                           "solver.method=list:radau,bdf",
                                           "--vary",
                                           "controller.pd.kv.0.0=list:0.6,-9",
                                           "--set",
                                           "time.step=0.1"};

std::vector<std::string> with(std::vector<std::string> words,
                              const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("sweeps are compared, and their texts must be equal") {
  const Folder folder;
  REQUIRE(bbsim(with(sweep_words, {"-o", "a.csv"}), folder.path()).exit_code == 0);
  REQUIRE(bbsim(with(sweep_words, {"-o", "a.h5"}), folder.path()).exit_code == 0);
  const Result same = bbsim({"compare", "a.csv", "a.h5"}, folder.path());
  CAPTURE(same.out, same.err);
  CHECK(same.exit_code == 0);
  CHECK(contains(same.out, "alike: a.csv and a.h5"));
  CHECK(contains(same.out, "\nsolver.method"));

  std::string changed = folder.read("a.csv");
  changed.replace(changed.find(",bdf,"), 5, ",BDF,");
  folder.write("b.csv", changed);
  const Result different = bbsim({"compare", "a.csv", "b.csv"}, folder.path());
  CHECK(different.exit_code == 1);
  CHECK(contains(different.out,
                 "different: worst in column solver.method, row 2: \"bdf\" in a.csv, \"BDF\" in "
                 "b.csv"));
  CHECK(bbsim({"compare", "a.csv", "b.csv", "--columns", "case,end_x,status"}, folder.path())
            .exit_code == 0);
}

TEST_CASE("trajectories of a sweep are compared number by number") {
  const Folder folder;
  const std::vector<std::string> words{
      "sweep", config("fig2a.yaml"), "-q",     "--keep-trajectories",
      "--set", "time.step=1",        "--vary", "ball.radius=list:0.01,0.02"};
  REQUIRE(bbsim(with(words, {"-o", "a.h5"}), folder.path()).exit_code == 0);
  REQUIRE(bbsim(with(words, {"-o", "b.h5", "--set", "ball.position.0=1e-3"}), folder.path())
              .exit_code == 0);
  CHECK(bbsim({"compare", "a.h5", "a.h5"}, folder.path()).exit_code == 0);
  const Result different = bbsim({"compare", "a.h5", "b.h5", "--columns", "x"}, folder.path());
  CHECK(different.exit_code == 1);
  CHECK(contains(different.out, "different: worst in column x, row 0 (t = 10): 0.12899"));
  const Result all = bbsim({"compare", "a.h5", "b.h5"}, folder.path());
  CHECK(contains(all.out,
                 "different: worst in column end_x, row 0: 0.12899"));  // no column t
  REQUIRE(bbsim(with(words, {"-o", "c.h5", "--set", "time.step=2"}), folder.path()).exit_code == 0);
  const Result wider = bbsim({"compare", "a.h5", "c.h5"}, folder.path());
  CHECK(wider.exit_code == 1);
  CHECK(contains(wider.out, "different: column x has 11 numbers a row in a.h5, 6 in c.h5"));
}

TEST_CASE("files that record their solver's tolerances are compared with them") {
  const Folder folder;
  const auto run = [&](const std::string& output, const std::string& more) {
    return shell("\"$BBSIM\" run '" + config("fig2b.yaml") + "' -q -o " + output + " " + more,
                 folder.path())
        .exit_code;
  };
  // Equal within the solver's tolerances, but not bit for bit.
  REQUIRE(run("a.h5", "") == 0);
  REQUIRE(run("b.h5", "--set solver.rtol=1.01e-8") == 0);
  REQUIRE(run("b.csv", "--set solver.rtol=1.01e-8") == 0);
  const Result alike = bbsim({"compare", "a.h5", "b.h5"}, folder.path());
  CAPTURE(alike.out, alike.err);
  CHECK(alike.exit_code == 0);
  CHECK(contains(alike.out,
                 "allowed: 100 (rtol size + atol) for each file, by its solver's rtol 1e-08, atol "
                 "1e-10 and rtol 1.01e-08, atol 1e-10\n"));
  CHECK(contains(alike.out, "within the solver's tolerances"));
  CHECK(bbsim({"compare", "a.h5", "b.csv"}, folder.path()).exit_code ==
        0);  // one of them has the tolerances
  // Explicit tolerances take precedence, and CSV files carry none.
  CHECK(bbsim({"compare", "a.h5", "b.h5", "--rtol", "1e-15"}, folder.path()).exit_code == 1);
  REQUIRE(run("a.csv", "") == 0);
  CHECK(bbsim({"compare", "a.csv", "b.csv"}, folder.path()).exit_code == 1);

  // A different scene is reported as different.
  REQUIRE(run("c.h5", "--set ball.position.0=0.0500025") == 0);
  const Result other = bbsim({"compare", "a.h5", "c.h5"}, folder.path());
  CHECK(other.exit_code == 1);
  CHECK(contains(other.out, "different: worst in column "));

  // With --error, positions are compared within its bound.
  REQUIRE(run("d.h5", "--error 1e-7") == 0);
  REQUIRE(run("e.h5", "--error 1e-9") == 0);
  const Result bound = bbsim({"compare", "d.h5", "e.h5", "--columns", "t,x,y"}, folder.path());
  CAPTURE(bound.out);
  CHECK(bound.exit_code == 0);
  CHECK(contains(bound.out, "positions to 1e-07 m"));
  CHECK(contains(bound.out, "positions to 1e-09 m"));
}

TEST_CASE("results of different instruction sets agree within their files' tolerances") {
  const Folder folder;
  for (const std::string scene : {"fig2b", "hold", "recorded", "hard/stiff-servo"}) {
    std::vector<std::string> files;
    for (const std::string set : {"avx512", "avx2", "sse2"}) {
      const Result run = shell("BBSIM_SIMD=" + set + " \"$BBSIM\" run '" + config(scene + ".yaml") +
                                   "' -q -o " + set +
                                   ".h5 --set 'output.columns=[t, x, y, vx, vy, spin, gamma, phi, "
                                   "phi_rate, phi_acceleration, normal_force, torque_phi]'",
                               folder.path());
      if (run.exit_code == 0) files.push_back(set + ".h5");  // only sets that this machine supports
    }
    REQUIRE(!files.empty());
    for (const std::string& file : files) {
      const Result compared = bbsim({"compare", files.back(), file}, folder.path());
      CAPTURE(scene, file, compared.out);
      CHECK(compared.exit_code == 0);
    }
  }
}

TEST_CASE("a sweep records its solver's tolerances unless they vary") {
  const Folder folder;
  const std::string fig2b = config("fig2b.yaml");
  const std::vector<std::string> words{"sweep", fig2b, "-q", "--vary",
                                       "ball.radius=list:0.01,0.02"};
  REQUIRE(bbsim(with(words, {"-o", "a.h5"}), folder.path()).exit_code == 0);
  REQUIRE(
      bbsim(with(words, {"-o", "b.h5", "--set", "solver.method=bdf"}), folder.path()).exit_code ==
      0);
  const Result alike = bbsim({"compare", "a.h5", "b.h5"}, folder.path());
  CAPTURE(alike.out);
  CHECK(alike.exit_code == 0);
  CHECK(contains(alike.out, "by its solver's rtol 1e-08, atol 1e-10\n"));
  REQUIRE(bbsim({"sweep", fig2b, "-q", "--vary", "solver.rtol=list:1e-6,1e-8", "-o", "c.h5"},
                folder.path())
              .exit_code == 0);
  CHECK(contains(bbsim({"compare", "c.h5", "c.h5"}, folder.path()).out, "within rtol 1e-09"));
}

TEST_CASE("a rig's log is compared with a run at the log's times") {
  const Folder folder;
  folder.write("run.csv", "t,x,vx\n0,0,0\n1,0.01,0.02\n2,0.04,0.04\n3,0.09,0.06\n");
  folder.write("log.csv", "Rig 3\nmillis;px\n5000;10,0\n5500;12,5\n6000;20,0\n7000;50,0\n");
  const std::vector<std::string> words{
      "compare", "log.csv", "run.csv", "--map", "t=millis:ms,x=px-10:mm", "--time-offset"};
  const Result made = bbsim(with(words, {"start"}), folder.path());
  CAPTURE(made.out, made.err);
  CHECK(made.exit_code == 0);
  CHECK(contains(made.out, "log.csv from run.csv: 4 of 4 rows, 0 to 2 s"));
  CHECK(contains(made.err, "the header is line 2"));
  CHECK(bbsim(with(words, {"start", "--atol", "1e-9"}), folder.path()).exit_code == 0);
  const Result moved = bbsim(with(words, {"-4.5 s", "--atol", "1e-3"}), folder.path());
  CHECK(moved.exit_code == 1);
  CHECK(contains(moved.out, "different: x is more than 0.001 apart"));
  folder.write("gaps.csv", "millis;px\n5000;10\n5500;-1\n6000;20\n");
  auto gaps = with(words, {"start", "--missing", "-1", "--atol", "1e-9"});
  gaps[1] = "gaps.csv";
  const Result seen = bbsim(gaps, folder.path());
  CAPTURE(seen.err);
  CHECK(seen.exit_code == 0);
  CHECK(contains(seen.out, "gaps.csv from run.csv: 2 of 2 rows, 0 to 1 s"));
  CHECK(contains(seen.err, "1 row has a position of -1, first in row 2; left out"));
  folder.write("words.csv", "when,x\nearly,0.01\nlate,0.02\n");
  const Result worded = bbsim({"compare", "words.csv", "run.csv", "--map", "x=x"}, folder.path());
  CHECK(worded.exit_code == 2);
  CHECK(contains(worded.err, "no column t with numbers; it has the text when, x"));
  const Result found = bbsim(with(words, {"auto"}), folder.path());
  CHECK(found.exit_code == 0);
  CHECK(contains(found.err, "log.csv: moved by "));
}

TEST_CASE("a log is compared with a run of a scenario at the log's times") {
  const Folder folder;
  const std::vector<std::string> fine{"run", config("fig2a.yaml"), "--set", "time.step=0.013",
                                      "-q"};
  REQUIRE(bbsim(with(fine, {"-o", "log.csv"}), folder.path()).exit_code == 0);
  // Rows between those of the scenario's output, with columns that the scenario does not request.
  const Result made = bbsim({"compare", "log.csv", config("fig2a.yaml"), "--set", "time.step=0.5",
                             "--columns", "x,y", "--atol", "1e-7", "-q"},
                            folder.path());
  CAPTURE(made.out, made.err);
  CHECK(made.exit_code == 0);
  CHECK(contains(made.out, "log.csv from "));
  const Result other = bbsim({"compare", "log.csv", config("fig2a.yaml"), "--set",
                              "ball.position.0=0.01", "--atol", "1e-7", "-q"},
                             folder.path());
  CHECK(other.exit_code == 1);
  CHECK(bbsim({"compare", "log.csv", "log.csv", "--set", "ball.radius=0.02"}, folder.path())
            .exit_code == 2);
}

}  // namespace bbsim_test::test_compare
