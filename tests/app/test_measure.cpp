// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures on the command line: of a run, a stored run and a sweep, and by group.
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "catch.hpp"
#include "process.hpp"
#include "shell.hpp"

namespace bbsim_test::test_measure {

namespace {

// Parses "measure,value" lines.
std::map<std::string, double> values_of(const std::string& text) {
  std::map<std::string, double> values;
  for (const auto& row : rows(text)) {
    if (row.at(0) != "measure") values[row[0]] = std::stod(row.at(1));
  }
  CHECK(text.starts_with("measure,value\n"));
  return values;
}

// Runs a command that prints measures.
std::map<std::string, double> measured(const std::string& line, const Folder& folder) {
  return values_of(expect(0, line, folder).out);
}

}  // namespace

TEST_CASE("run prints measures of the motion, and measure prints those of its rows") {
  const Folder folder;
  const auto motion = measured(
      "run @step.yaml -o step.h5 --summary step.json --measure "
      "x.RiseTime,x.SettlingTime,x.SettlingMin,x.SettlingMax,x.Overshoot,x.Undershoot,x.Peak,"
      "x.PeakTime,x.SteadyStateValue,max_tilt,end_x --measure "
      "'when tracking_error stays below 2 mm'",
      folder);
  CHECK(motion.size() == 12);
  CHECK(motion.at("x.RiseTime") > 0);
  CHECK(motion.at("x.Peak") >= motion.at("x.SettlingMax"));
  CHECK(motion.at("x.SteadyStateValue") == motion.at("end_x"));
  CHECK(motion.at("when tracking_error stays below 0.002") > 0);

  const auto measures = summary_of(folder, "step.json")["measures"];
  CHECK(measures.size() == 12);
  CHECK(measures["x.RiseTime"] == motion.at("x.RiseTime"));

  for (const auto& [name, value] :
       measured("measure step.h5 --measure x.RiseTime,x.SettlingTime,x.Overshoot,x.Peak,"
                "x.PeakTime,end_x",
                folder)) {
    CAPTURE(name);
    // Rows are at most 10 ms apart.
    CHECK(value == Approx(motion.at(name)).epsilon(0.02));
  }
}

TEST_CASE("unavailable measures are refused with the list of allowed ones") {
  const Folder folder;
  for (const std::string line :
       {"run @step.yaml --measure x.Rise", "run @step.yaml --measure x.Peak,x.Peak",
        "run @fig2a.yaml --measure x_reference.Peak", "run @step.yaml --measure x.Peak -o -",
        "run @step.yaml --measure x.Peak --summary -"}) {
    expect(2, line, folder);
  }
  CHECK(folder.files().empty());
  folder.write("rows.csv", "t,u\n0,0\n1,1\n");
  for (const std::string line : {"measure rows.csv --measure x.Peak", "measure rows.csv",
                                 "measure none.csv --measure x.Peak"}) {
    expect(2, line, folder);
  }
  CHECK(measured("measure rows.csv --measure u.Peak", folder).at("u.Peak") == 1);
  const Result piped = shell("$BBSIM measure - --measure 'when u=0.25' < rows.csv", folder);
  CHECK(values_of(piped.out).at("when u=0.25 cross=1") == 0.25);
}

TEST_CASE("a switch at a run's last instant counts in its extremes") {
  const Folder folder;
  const std::string first_order =
      " @rig.yaml -q --set 'gimbal.servo={time_constant: 0.05}' --set time.end=0.01 --measure "
      "max_tilt_rate";
  // The first command arrives at 10 ms.
  const auto at_end = measured(
      "run" + first_order + ",end_tilt_rate,max_motor_torque_theta,end_motor_torque_theta -o " +
          "end.csv --summary end.json",
      folder);
  CHECK(at_end.at("end_tilt_rate") > 0.1);
  CHECK(at_end.at("max_tilt_rate") == at_end.at("end_tilt_rate"));
  CHECK(at_end.at("max_motor_torque_theta") >= at_end.at("end_motor_torque_theta"));
  CHECK(summary_of(folder, "end.json")["motors"]["peak_torque_theta"] >=
        at_end.at("end_motor_torque_theta"));

  expect(0, "sweep" + first_order + " -o sweep.csv --vary controller.sensor.seed=linear:1:9:9",
         folder);
  const auto first = rows(folder.read("sweep.csv"))[1];
  CHECK(first[2] == "done");
  CHECK(std::stod(first.back()) == at_end.at("max_tilt_rate"));

  const auto at_stop = values_of(
      expect(1,
             "run @catch.yaml -q -o stop.csv --set gimbal.servo.acceleration_limit=60 --measure "
             "min_normal_force,end_normal_force",
             folder)
          .out);
  CHECK(at_stop.at("end_normal_force") < 0);
  CHECK(at_stop.at("min_normal_force") == at_stop.at("end_normal_force"));
}

TEST_CASE("any rig's log is measured, whatever its other columns") {
  const Folder folder;
  folder.write("log.csv", "\"t\",x (m),y,mode\n0,1,2,auto\n1,3,4,man\n");
  CHECK(measured("measure log.csv --measure max_y", folder).at("max_y") == 4);
  expect(2, "measure log.csv --measure max_mode", folder,
         {":2:7: column mode: found \"auto\"; allowed: a number"});
  folder.write("late.csv", "t,x\n0,1\n,off\n1,3\n");  // the row of the text has no time
  CHECK(measured("measure late.csv --measure max_x", folder).at("max_x") == 3);
  folder.write("words.csv", "t,x,when,at\n0,1,a,b\n1,2,c,d\n2,3,e,f\n");
  CHECK(measured("measure words.csv --measure 'when x=1.5'", folder).at("when x=1.5 cross=1") ==
        Approx(0.5).epsilon(1e-15));
  folder.write("sweep.csv", "case,ball.radius,status,end_x\n0,0.01,done,1\n1,0.02,done,2\n");
  expect(2, "measure sweep.csv --measure end_x", folder, {"is a sweep"});
}

TEST_CASE("steps are measured from the ball's start, and a file without a reference is reported") {
  const Folder folder;
  const Result run = expect(0,
                            "run @step.yaml -o step.csv --summary s.json --measure "
                            "x.Overshoot,x.RiseTime,x.Peak,y.Overshoot",
                            folder);
  const auto motion = values_of(run.out);
  // From -3 cm to +3 cm, with a peak at 5.47 cm.
  CHECK(motion.at("x.Peak") == Approx(0.0547).epsilon(1e-3));
  CHECK(motion.at("x.Overshoot") == Approx(100 * (motion.at("x.Peak") - 0.03) / 0.06));
  // y stays where it is: a step of 0 has no step metrics, and that is reported.
  CHECK(std::isnan(motion.at("y.Overshoot")));
  for (const std::string& text : {run.err, folder.read("s.json")}) {
    CHECK(contains(text, "y.Overshoot is not a number: "));
  }

  const Result stored =
      expect(0, "measure step.csv --measure x.Overshoot", folder, {"!note: ", "!warning"});
  CHECK(values_of(stored.out).at("x.Overshoot") ==
        Approx(motion.at("x.Overshoot")).epsilon(1e-3));  // rows are 20 ms apart
  expect(0, "run @step.yaml -q -o plain.csv --set 'output.columns=[t, x]'", folder);
  expect(0, "measure plain.csv --measure x.Overshoot", folder,
         {"note: plain.csv has no column x_reference"});
  CHECK(call("measure plain.csv --measure x.Overshoot -q", folder).err.empty());
}

TEST_CASE("a time window applies to runs, files and sweeps") {
  const Folder folder;
  const std::string names =
      "rms_tracking_error from 5 s,max_x to 3000 ms,end_x to 2 s,x.Overshoot from 1 s to 8 s";
  const std::string measure = " --measure '" + names + "'";
  const Result run = expect(0,
                            "run @step.yaml -q -o step.h5 --set 'output.columns=[t, x, "
                            "x_reference, tracking_error]' --summary s.json" +
                                measure,
                            folder);
  const auto motion = values_of(run.out);
  CHECK(summary_of(folder, "s.json")["measures"]["max_x to 3000 ms"] ==
        motion.at("max_x to 3000 ms"));
  const auto stored = measured("measure step.h5" + measure, folder);
  for (const auto& [name, value] : stored) {
    CAPTURE(name);
    CHECK(motion.at(name) == Approx(value).epsilon(1e-3));  // rows are 20 ms apart
  }
  CHECK(stored.at("rms_tracking_error from 5 s") ==
        Approx(motion.at("rms_tracking_error from 5 s")).epsilon(1e-14));

  const auto table =
      rows(expect(0, "sweep @step.yaml -q -o - --vary controller.pid.kp.0.0=list:0.7,0.8" + measure,
                  folder)
               .out);
  REQUIRE(table.at(0).size() == 9);
  for (std::size_t i = 5; i < 9; ++i) {
    CHECK(std::stod(table[1].at(i)) == motion.at(table[0][i]));
  }
  for (const std::string wrong : {"max_x from 12 s", "max_x from 2 s to 1 s", "max_x to 13 s"}) {
    expect(2, "run @step.yaml --measure '" + wrong + "'", folder);
    expect(2, "measure step.h5 --measure '" + wrong + "'", folder);
  }
}

TEST_CASE("expectations of a run are judged, reported and recorded") {
  const Folder folder;
  const std::string run = "run @step.yaml -q -o step.h5 --summary s.json --expect '";
  const Result met =
      expect(0, run + "x.Overshoot < 45 %' --expect 'rms_x from 5 s >= 3 cm'", folder);
  CHECK(met.out.empty());
  CHECK(met.err.empty());
  expect(1,
         run +
             "x.Overshoot<=41' --expect 'max_tilt < 180 deg' --expect 'when x=1 m < 3 s' "
             "--measure end_x",
         folder,
         {"not as expected: x.Overshoot<=41: x.Overshoot is 41.1",
          "not as expected: when x=1 m < 3 s: when x=1 cross=1 is not a number", "!max_tilt"},
         {"measure,value\nend_x,0.03", "!Overshoot"});
  const auto summary = summary_of(folder, "s.json");
  CHECK(summary["status"] == "done");
  const auto& expectations = summary["expectations"];
  REQUIRE(expectations.size() == 3);
  CHECK(expectations[0]["text"] == "x.Overshoot<=41");
  CHECK(expectations[0]["value"] > 41);
  CHECK(expectations[0]["holds"] == false);
  CHECK(expectations[1]["holds"] == true);
  CHECK(expectations[2]["value"].is_null());
  CHECK(summary["measures"].size() == 1);
  for (const std::string wrong : {"max_x", "max_x < 1 deg", "max_z < 1", "max_x from 13 s < 1"}) {
    expect(2, run + wrong + "'", folder, {"--expect: found "});
  }
}

TEST_CASE("a log that seems to use units other than bbsim's gives a warning") {
  const Folder folder;
  folder.write("log.csv", "t,x,phi,other\n0,0,0,0\n1000,120,5,7\n2000,60,-12,7\n3000,0,0,7\n");
  expect(0, "measure log.csv --measure max_x,max_phi,max_other", folder,
         {"warning: log.csv: x goes up to 120", "like millimeters or centimeters\n",
          "warning: log.csv: phi goes up to 12", "like degrees\n", "!other"});
  // A result of bbsim's is in SI, however large its values.
  expect(0, "run @fig2a.yaml -q -o far.h5 --set ball.position.0=100", folder);
  folder.write("run.csv", "t,x,phi,other\n0,0,0,0\n1,0.12,0.1,7\n2,0.06,-0.2,7\n3,0,0,7\n");
  expect(1, "compare run.csv log.csv", folder,
         {"warning: log.csv: t spans 3000, and in run.csv 3", "like milliseconds\n",
          "warning: log.csv: x goes up to 120, and in run.csv 0.12",
          "warning: log.csv: phi goes up to 12, and in run.csv 0.2", "!other"});
  for (const std::string line :
       {"measure log.csv --measure max_other", "measure log.csv --measure max_x -q",
        "measure far.h5 --measure max_x", "compare log.csv log.csv",
        "compare run.csv log.csv -q"}) {
    CAPTURE(line);
    CHECK(call(line, folder).err.empty());
  }

  // The same with a table.
  folder.write("s.yaml",
               "ball: {radius: 0.01}\n"
               "gimbal: {motion: {phi: {table: {file: log.csv, time: t, value: phi}}}}\n"
               "time: {end: 3, step: 1}\n");
  expect(0, "run s.yaml -o a.csv", folder,
         {"it looks like degrees; say unit: deg", "it looks like milliseconds; say time_unit: ms"});
  const std::string table = " --set gimbal.motion.phi.table.";
  const Result said = expect(
      0,
      "run s.yaml -o b.csv" + table + "unit=deg" + table + "time_unit=ms --measure max_phi,min_phi",
      folder, {"!warning"});
  CHECK(values_of(said.out).at("min_phi") < -0.2);  // -12 deg, plus interpolation
  CHECK(values_of(said.out).at("min_phi") > -0.3);
}

TEST_CASE("a sweep computes the step metrics of its runs") {
  const Folder folder;
  const std::string sweep =
      "sweep @step.yaml --vary controller.pid.kp.0.0=linear:0.6:0.8:3 --vary "
      "ball.radius=list:0.01,0.02 --measure 'x.RiseTime,x.Overshoot,when x=0.02' -q -o ";
  expect(0, sweep + "sweep.csv", folder);
  CHECK(lines(folder.read("sweep.csv"))[0].ends_with(
      ",end_time,x.RiseTime,x.Overshoot,when x=0.02 cross=1"));

  const Result groups = expect(0, "summarize sweep.csv --by ball.radius", folder, {},
                               {"ball.radius,measure,cases,count,mean,deviation,min,q5,q25,q50,",
                                "\n0.02,x.Overshoot,3,3,"});
  CHECK(call("summarise sweep.csv --by ball.radius", folder).out == groups.out);
  for (const std::string wrong : {"--by radius", "-o sweep.csv", "--quantiles 2"}) {
    expect(2, "summarize sweep.csv " + wrong, folder);
  }
  // HDF5 agrees.
  expect(0, sweep + "sweep.h5", folder);
  expect(0, "compare sweep.csv sweep.h5", folder);
}

TEST_CASE("a log is measured with its own names, units and clock") {
  const Folder folder;
  folder.write("log.csv", "10,ok\n20,ok\n40,ok\n");
  const std::string measure =
      "measure log.csv --header px,mode --map x=-0.5*px:mm --period '100 ms' --measure ";
  const Result made = expect(0, measure + "'min_x,find x at 0.1'", folder);
  CHECK(made.out == "measure,value\nmin_x,-0.02\nfind x at 0.1,-0.01\n");
  CHECK(made.err.empty());
  expect(2, measure + "min_x --time-offset auto", folder);
  expect(2, "measure fig.yaml --measure max_x", folder, {"bbsim run fig.yaml --measure max_x"});
}

TEST_CASE("run writes derivatives by keys as columns, and gradients of measures") {
  const Folder folder;
  const std::string run =
      "run @incline.yaml -q --set 'output.columns=[t, x, vx]' --sensitivity gravity,ball.radius "
      "--measure end_x --summary s.json -o by-key";
  const auto motion = measured(run + ".csv", folder);
  CHECK(lines(folder.read("by-key.csv"))[0] ==
        "t,x,vx,d(x)/d(gravity),d(x)/d(ball.radius),d(vx)/d(gravity),d(vx)/d(ball.radius)");
  const auto summary = summary_of(folder, "s.json");
  // x is proportional to gravity.
  CHECK(summary["gradients"]["end_x"]["gravity"].get<double>() ==
        Approx(motion.at("end_x") / 9.80665));
  CHECK(std::abs(summary["gradients"]["end_x"]["ball.radius"].get<double>()) < 1e-9);
  CHECK(summary["unreliable"] == nlohmann::json::array());
  expect(0, run + ".h5", folder);
  expect(0, "compare by-key.csv by-key.h5", folder);

  // Rounded measurements step.
  expect(0, "run @rig.yaml -o rig.csv --sensitivity gravity --measure rms_x --summary s.json",
         folder, {"unreliable derivatives by gravity: x (from t = "});
  CHECK_FALSE(contains(folder.read("rig.csv"), "nan"));
  const auto of_rig = summary_of(folder, "s.json");
  CHECK(of_rig["gradients"]["rms_x"]["gravity"].is_null());
  const auto& first = of_rig["unreliable"][0];
  CHECK(first["key"] == "gravity");
  CHECK(first["column"] == "x");
  CHECK(first["time"].get<double>() > 0);
  CHECK(of_rig["unreliable"].back() ==
        nlohmann::json{{"key", "gravity"}, {"column", "rms_x"}, {"time", nullptr}});

  expect(2, "run @incline.yaml -o none.csv --sensitivity time.end", folder,
         {"--sensitivity: time.end"});
  CHECK_FALSE(std::filesystem::exists(folder / "none.csv"));
}

TEST_CASE("measures of the loop equal linearize's to the last digit") {
  const Folder folder;
  expect(0, "linearize @step.yaml -q -o loop.json", folder);
  const auto loop = summary_of(folder, "loop.json");
  const auto values = values_of(
      expect(1,
             "run @step.yaml -q -o step.h5 --summary s.json --measure "
             "max_tilt,phi_gain_margin,theta_phase_margin,phi_delay_margin,y_feedback_bandwidth,"
             "stable,phi_gain_reduction --expect 'phi_delay_margin > 100 ms' --expect "
             "'phi_phase_margin < 10 deg'",
             folder, {"not as expected: phi_phase_margin < 10 deg: phi_phase_margin is "})
          .out);
  CHECK(values.at("phi_gain_margin") == loop["margins"]["phi_command"]["gain"]);
  CHECK(values.at("theta_phase_margin") == loop["margins"]["theta_command"]["phase"]);
  CHECK(values.at("phi_delay_margin") == loop["margins"]["phi_command"]["delay"]);
  CHECK(values.at("y_feedback_bandwidth") == loop["feedback_bandwidth"]["y"]);
  CHECK(values.at("stable") == 1);
  CHECK(values.at("max_tilt") > 0);
  const auto summary = summary_of(folder, "s.json");
  CHECK(summary["measures"]["phi_delay_margin"] == loop["margins"]["phi_command"]["delay"]);
  CHECK(summary["expectations"][0]["holds"] == true);

  expect(2, "measure step.h5 --measure phi_delay_margin", folder,
         {"which is of the loop and not of a motion"});
  for (const auto& [more, told] :
       {std::pair<std::string, std::string>{"'stable from 2 s'", "which takes no time window"},
        {"phi_delay_margn", "did you mean phi_delay_margin?"},
        {"spectral_radius", "the controller takes no samples"},
        {"stable --sensitivity gravity", "allowed: measures of the motion"}}) {
    expect(2, "run @fig2b.yaml --measure " + more, folder, {told});
  }
}

}  // namespace bbsim_test::test_measure
