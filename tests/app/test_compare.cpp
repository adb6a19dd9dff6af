// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim compare on the program's own results: runs and sweeps, CSV and HDF5.
#include <string>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_compare {

TEST_CASE("sweeps are compared, and their texts must be equal") {
  const Folder folder;
  const std::string sweep =
      "sweep @fig2b.yaml -q --vary solver.method=list:radau,bdf --vary "
      "controller.pd.kv.0.0=list:0.6,-9 --set time.step=0.1 -o ";
  expect(0, sweep + "a.csv", folder);
  expect(0, sweep + "a.h5", folder);
  expect(0, "compare a.csv a.h5", folder, {}, {"alike: a.csv and a.h5", "\nsolver.method"});

  std::string changed = folder.read("a.csv");
  changed.replace(changed.find(",bdf,"), 5, ",BDF,");
  folder.write("b.csv", changed);
  expect(1, "compare a.csv b.csv", folder, {},
         {"different: worst in column solver.method, row 2: \"bdf\" in a.csv, \"BDF\" in b.csv"});
  expect(0, "compare a.csv b.csv --columns case,end_x,status", folder);
}

TEST_CASE("trajectories of a sweep are compared number by number") {
  const Folder folder;
  const std::string sweep =
      "sweep @fig2a.yaml -q --keep-trajectories --vary ball.radius=list:0.01,0.02 --set ";
  expect(0, sweep + "time.step=1 -o a.h5", folder);
  expect(0, sweep + "time.step=1 -o b.h5 --set ball.position.0=1e-3", folder);
  expect(0, sweep + "time.step=2 -o c.h5", folder);
  expect(0, "compare a.h5 a.h5", folder);
  expect(1, "compare a.h5 b.h5 --columns x", folder, {},
         {"different: worst in column x, row 0 (t = 10): 0.12899"});
  expect(1, "compare a.h5 b.h5", folder, {},
         {"different: worst in column end_x, row 0: 0.12899"});  // no column t
  expect(1, "compare a.h5 c.h5", folder, {},
         {"different: column x has 11 numbers a row in a.h5, 6 in c.h5"});
}

TEST_CASE("files that record their solver's tolerances are compared with them") {
  const Folder folder;
  for (const std::string more :
       {"a.h5", "a.csv", "b.h5 --set solver.rtol=1.01e-8", "b.csv --set solver.rtol=1.01e-8",
        "c.h5 --set ball.position.0=0.0500025", "d.h5 --error 1e-7", "e.h5 --error 1e-9"}) {
    expect(0, "run @fig2b.yaml -q -o " + more, folder);
  }
  // Equal within the solver's tolerances, but not bit for bit.
  expect(0, "compare a.h5 b.h5", folder, {},
         {"by its solver's rtol 1e-08, atol 1e-10 and rtol 1.01e-08, atol 1e-10\n",
          "within the solver's tolerances"});
  expect(0, "compare a.h5 b.csv", folder);  // one of them has the tolerances
  // Explicit tolerances take precedence, and CSV files carry none.
  expect(1, "compare a.h5 b.h5 --rtol 1e-15", folder);
  expect(1, "compare a.csv b.csv", folder);
  // A different scene is reported as different.
  expect(1, "compare a.h5 c.h5", folder, {}, {"different: worst in column "});
  // With --error, positions are compared within its bound.
  expect(0, "compare d.h5 e.h5 --columns t,x,y", folder, {},
         {"positions to 1e-07 m", "positions to 1e-09 m"});
}

TEST_CASE("results of different instruction sets agree within their files' tolerances") {
  const Folder folder;
  const std::string scene = GENERATE("fig2b", "hold", "recorded", "hard/stiff-servo");
  std::string first;
  for (const std::string set : {"avx512", "avx2", "sse2"}) {
    const Result run =
        call_with("BBSIM_SIMD", set,
                  "run @" + scene + ".yaml -q -o " + set +
                      ".h5 --set 'output.columns=[t, x, y, vx, vy, spin, gamma, phi, phi_rate, "
                      "phi_acceleration, normal_force, torque_phi]'",
                  folder);
    if (run.exit_code != 0) continue;  // a set that this machine lacks
    if (first.empty()) first = set;
    expect(0, "compare " + first + ".h5 " + set + ".h5", folder);
  }
  CHECK_FALSE(first.empty());
}

TEST_CASE("a sweep records its solver's tolerances unless they vary") {
  const Folder folder;
  const std::string sweep = "sweep @fig2b.yaml -q --vary ";
  expect(0, sweep + "ball.radius=list:0.01,0.02 -o a.h5", folder);
  expect(0, sweep + "ball.radius=list:0.01,0.02 -o b.h5 --set solver.method=bdf", folder);
  expect(0, sweep + "solver.rtol=list:1e-6,1e-8 -o c.h5", folder);
  expect(0, "compare a.h5 b.h5", folder, {}, {"by its solver's rtol 1e-08, atol 1e-10\n"});
  expect(0, "compare c.h5 c.h5", folder, {}, {"within rtol 1e-09"});
}

TEST_CASE("a rig's log is compared with a run at the log's times") {
  const Folder folder;
  folder.write("run.csv", "t,x,vx\n0,0,0\n1,0.01,0.02\n2,0.04,0.04\n3,0.09,0.06\n");
  folder.write("log.csv", "Rig 3\nmillis;px\n5000;10,0\n5500;12,5\n6000;20,0\n7000;50,0\n");
  const std::string columns = ".csv run.csv --map t=millis:ms,x=px-10:mm --time-offset ";
  expect(0, "compare log" + columns + "start", folder, {"the header is line 2"},
         {"log.csv from run.csv: 4 of 4 rows, 0 to 2 s"});
  expect(0, "compare log" + columns + "start --atol 1e-9", folder);
  expect(1, "compare log" + columns + "'-4.5 s' --atol 1e-3", folder, {},
         {"different: x is more than 0.001 apart"});
  expect(0, "compare log" + columns + "auto", folder, {"log.csv: moved by "});
  folder.write("gaps.csv", "millis;px\n5000;10\n5500;-1\n6000;20\n");
  expect(1, "compare log.csv run.csv", folder, {"if log.csv is a log, --time-offset 0"});
  expect(0, "compare gaps" + columns + "start --missing -1 --atol 1e-9", folder,
         {"1 row has a position of -1, first in row 2; left out"},
         {"gaps.csv from run.csv: 2 of 2 rows, 0 to 1 s"});
  folder.write("words.csv", "when,x\nearly,0.01\nlate,0.02\n");
  expect(2, "compare words.csv run.csv --map x=x", folder,
         {"no column t with numbers; it has the text when, x"});
}

TEST_CASE("a log is compared with a run of a scenario at the log's times") {
  const Folder folder;
  expect(0, "run @fig2a.yaml --set time.step=0.013 -q -o log.csv", folder);
  // Rows between those of the scenario's output, with columns that the scenario does not request.
  const std::string compare = "compare log.csv @fig2a.yaml --atol 1e-7 -q --set ";
  expect(0, compare + "time.step=0.5 --columns x,y", folder, {}, {"log.csv from "});
  expect(1, compare + "ball.position.0=0.01", folder);
  expect(2, "compare log.csv log.csv --set ball.radius=0.02", folder);
}

}  // namespace bbsim_test::test_compare
