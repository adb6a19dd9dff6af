// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures on the command line: of a run, a stored run and a sweep, and by group.
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "catch.hpp"
#include "process.hpp"
#include "shell.hpp"

namespace bbsim_test::test_measure {

namespace {

// Parses "measure,value" lines.
std::map<std::string, double> values_of(const std::string& text) {
  std::map<std::string, double> values;
  std::istringstream lines(text);
  std::string line;
  REQUIRE(std::getline(lines, line));
  CHECK(line == "measure,value");
  while (std::getline(lines, line)) {
    const std::size_t comma = line.rfind(',');
    values[line.substr(0, comma)] = std::stod(line.substr(comma + 1));
  }
  return values;
}

}  // namespace

TEST_CASE("run prints measures of the motion, and measure prints those of its rows") {
  const Folder folder;
  const std::string names =
      "x.RiseTime,x.SettlingTime,x.SettlingMin,x.SettlingMax,x.Overshoot,"
      "x.Undershoot,x.Peak,x.PeakTime,x.SteadyStateValue,max_tilt,end_x";
  const Result run =
      bbsim({"run", config("step.yaml"), "-o", "step.h5", "--summary", "step.json", "--measure",
             names, "--measure", "when tracking_error stays below 2 mm"},
            folder.path());
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  const auto motion = values_of(run.out);
  CHECK(motion.size() == 12);
  CHECK(motion.at("x.RiseTime") > 0);
  CHECK(motion.at("x.Peak") >= motion.at("x.SettlingMax"));
  CHECK(motion.at("x.SteadyStateValue") == motion.at("end_x"));
  CHECK(motion.at("when tracking_error stays below 0.002") > 0);

  const auto summary = nlohmann::json::parse(folder.read("step.json"));
  CHECK(summary["measures"].size() == 12);
  CHECK(summary["measures"]["x.RiseTime"] == motion.at("x.RiseTime"));

  const Result stored = bbsim({"measure", "step.h5", "--measure",
                               "x.RiseTime,x.SettlingTime,x.Overshoot,x.Peak,x.PeakTime,end_x"},
                              folder.path());
  CAPTURE(stored.err);
  REQUIRE(stored.exit_code == 0);
  for (const auto& [name, value] : values_of(stored.out)) {
    CAPTURE(name);
    // Rows are at most 10 ms apart.
    CHECK(value == Approx(motion.at(name)).epsilon(0.02));
  }
}

TEST_CASE("unavailable measures are refused with the list of allowed ones") {
  const Folder folder;
  const auto code = [&](std::vector<std::string> arguments) {
    return bbsim(std::move(arguments), folder.path()).exit_code;
  };
  CHECK(code({"run", config("step.yaml"), "--measure", "x.Rise"}) == 2);
  CHECK(code({"run", config("step.yaml"), "--measure", "x.Peak,x.Peak"}) == 2);
  CHECK(code({"run", config("fig2a.yaml"), "--measure", "x_reference.Peak"}) == 2);
  CHECK(code({"run", config("step.yaml"), "--measure", "x.Peak", "-o", "-"}) == 2);
  CHECK(code({"run", config("step.yaml"), "--measure", "x.Peak", "--summary", "-"}) == 2);
  CHECK(folder.files().empty());
  folder.write("rows.csv", "t,u\n0,0\n1,1\n");
  CHECK(code({"measure", "rows.csv", "--measure", "x.Peak"}) == 2);
  CHECK(code({"measure", "rows.csv"}) == 2);
  CHECK(code({"measure", "none.csv", "--measure", "x.Peak"}) == 2);
  CHECK(bbsim({"measure", "rows.csv", "--measure", "u.Peak"}, folder.path()).out ==
        "measure,value\nu.Peak,1\n");
  CHECK(shell("$BBSIM measure - --measure 'when u=0.25' < rows.csv", folder.path()).out ==
        "measure,value\nwhen u=0.25 cross=1,0.25\n");
}

TEST_CASE("a switch at a run's last instant counts in its extremes") {
  const Folder folder;
  const std::string first_order = "gimbal.servo={time_constant: 0.05}";
  const std::string names =
      "max_tilt_rate,end_tilt_rate,max_motor_torque_theta,end_motor_torque_theta";
  // The first command arrives at 10 ms.
  const Result run = bbsim({"run", config("rig.yaml"), "-q", "-o", "end.csv", "--set", first_order,
                            "--set", "time.end=0.01", "--measure", names, "--summary", "end.json"},
                           folder.path());
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  const auto at_end = values_of(run.out);
  CHECK(at_end.at("end_tilt_rate") > 0.1);
  CHECK(at_end.at("max_tilt_rate") == at_end.at("end_tilt_rate"));
  CHECK(at_end.at("max_motor_torque_theta") >= at_end.at("end_motor_torque_theta"));
  const auto summary = nlohmann::json::parse(folder.read("end.json"));
  CHECK(summary["motors"]["peak_torque_theta"] >= at_end.at("end_motor_torque_theta"));

  const Result sweep = bbsim({"sweep", config("rig.yaml"), "-q", "-o", "sweep.csv", "--set",
                              first_order, "--set", "time.end=0.01", "--vary",
                              "controller.sensor.seed=linear:1:9:9", "--measure", "max_tilt_rate"},
                             folder.path());
  CAPTURE(sweep.err);
  REQUIRE(sweep.exit_code == 0);
  const std::string rows = folder.read("sweep.csv");
  const std::size_t row = rows.find("\n0,1,done,,0.01,");
  REQUIRE(row != std::string::npos);
  CHECK(std::stod(rows.substr(row + 16)) == at_end.at("max_tilt_rate"));

  const Result stopped = bbsim(
      {"run", config("catch.yaml"), "-q", "-o", "stop.csv", "--set",
       "gimbal.servo.acceleration_limit=60", "--measure", "min_normal_force,end_normal_force"},
      folder.path());
  CHECK(stopped.exit_code == 1);
  const auto at_stop = values_of(stopped.out);
  CHECK(at_stop.at("end_normal_force") < 0);
  CHECK(at_stop.at("min_normal_force") == at_stop.at("end_normal_force"));
}

TEST_CASE("any rig's log is measured, whatever its other columns") {
  const Folder folder;
  folder.write("log.csv", "\"t\",x (m),y,mode\n0,1,2,auto\n1,3,4,man\n");
  CHECK(bbsim({"measure", "log.csv", "--measure", "max_y"}, folder.path()).out ==
        "measure,value\nmax_y,4\n");
  const Result words = bbsim({"measure", "log.csv", "--measure", "max_mode"}, folder.path());
  CHECK(words.exit_code == 2);
  CHECK(words.err.find("column mode, row 1: found \"auto\"; allowed: a number") !=
        std::string::npos);
  folder.write("words.csv", "t,x,when,at\n0,1,a,b\n1,2,c,d\n2,3,e,f\n");
  CHECK(bbsim({"measure", "words.csv", "--measure", "when x=1.5"}, folder.path()).out ==
        "measure,value\nwhen x=1.5 cross=1,0.4999999999999999\n");
  folder.write("sweep.csv", "case,ball.radius,status,end_x\n0,0.01,done,1\n1,0.02,done,2\n");
  const Result sweep = bbsim({"measure", "sweep.csv", "--measure", "end_x"}, folder.path());
  CHECK(sweep.exit_code == 2);
  CHECK(sweep.err.find("is a sweep") != std::string::npos);
}

TEST_CASE("steps are measured from the ball's start, and a file without a reference is reported") {
  const Folder folder;
  const std::string names = "x.Overshoot,x.RiseTime,x.Peak,y.Overshoot";
  const Result run = bbsim(
      {"run", config("step.yaml"), "-o", "step.csv", "--measure", names, "--summary", "s.json"},
      folder.path());
  REQUIRE(run.exit_code == 0);
  const auto motion = values_of(run.out);
  // From -3 cm to +3 cm, with a peak at 5.47 cm.
  CHECK(motion.at("x.Peak") == Approx(0.0547).epsilon(1e-3));
  CHECK(motion.at("x.Overshoot") == Approx(100 * (motion.at("x.Peak") - 0.03) / 0.06));
  // y stays where it is: a step of 0 has no step metrics, and that is reported.
  CHECK(std::isnan(motion.at("y.Overshoot")));
  const std::string why =
      "y.Overshoot is not a number: it should end where it starts, so its step is 0";
  CHECK(run.err.find("note: " + why) != std::string::npos);
  CHECK(folder.read("s.json").find(why) != std::string::npos);

  const Result stored = bbsim({"measure", "step.csv", "--measure", "x.Overshoot"}, folder.path());
  CHECK(values_of(stored.out).at("x.Overshoot") ==
        Approx(motion.at("x.Overshoot")).epsilon(1e-3));  // rows are 20 ms apart
  CHECK(stored.err.empty());
  REQUIRE(
      bbsim({"run", config("step.yaml"), "-q", "-o", "plain.csv", "--set", "output.columns=[t, x]"},
            folder.path())
          .exit_code == 0);
  const Result plain = bbsim({"measure", "plain.csv", "--measure", "x.Overshoot"}, folder.path());
  CHECK(plain.exit_code == 0);
  CHECK(plain.err ==
        "note: plain.csv has no column x_reference: step metrics of x refer to its own value at "
        "the end\n");
  CHECK(
      bbsim({"measure", "plain.csv", "--measure", "x.Overshoot", "-q"}, folder.path()).err.empty());
}

TEST_CASE("a time window applies to runs, files and sweeps") {
  const Folder folder;
  const std::string names =
      "rms_tracking_error from 5 s,max_x to 3000 ms,end_x to 2 s,x.Overshoot from 1 s to 8 s";
  const Result run = bbsim({"run", config("step.yaml"), "-q", "-o", "step.h5", "--set",
                            "output.columns=[t, x, x_reference, tracking_error]", "--measure",
                            names, "--summary", "s.json"},
                           folder.path());
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  const auto motion = values_of(run.out);
  const auto summary = nlohmann::json::parse(folder.read("s.json"));
  CHECK(summary["measures"]["max_x to 3000 ms"] == motion.at("max_x to 3000 ms"));
  const Result stored = bbsim({"measure", "step.h5", "--measure", names}, folder.path());
  for (const auto& [name, value] : values_of(stored.out)) {
    CAPTURE(name);
    CHECK(motion.at(name) == Approx(value).epsilon(1e-3));  // rows are 20 ms apart
  }
  CHECK(values_of(stored.out).at("rms_tracking_error from 5 s") ==
        Approx(motion.at("rms_tracking_error from 5 s")).epsilon(1e-14));
  const Result sweep = bbsim({"sweep", config("step.yaml"), "-q", "-o", "-", "--vary",
                              "controller.pid.kp.0.0=list:0.7,0.8", "--measure", names},
                             folder.path());
  REQUIRE(sweep.exit_code == 0);
  std::istringstream lines(sweep.out);
  std::string header, row;
  std::getline(lines, header);
  std::getline(lines, row);
  CHECK(header.ends_with("," + names));
  std::string expected;
  for (const std::string name : {"rms_tracking_error from 5 s", "max_x to 3000 ms", "end_x to 2 s",
                                 "x.Overshoot from 1 s to 8 s"}) {
    const std::size_t at = run.out.find(name) + name.size();
    expected += run.out.substr(at, run.out.find('\n', at) - at);
  }
  CHECK(row.ends_with(",12" + expected));
  for (const char* wrong : {"max_x from 12 s", "max_x from 2 s to 1 s", "max_x to 13 s"}) {
    CAPTURE(wrong);
    CHECK(bbsim({"run", config("step.yaml"), "--measure", wrong}, folder.path()).exit_code == 2);
    CHECK(bbsim({"measure", "step.h5", "--measure", wrong}, folder.path()).exit_code == 2);
  }
}

TEST_CASE("expectations of a run are judged, reported and recorded") {
  const Folder folder;
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run",     config("step.yaml"), "-q",    "-o",
                                       "step.h5", "--summary",         "s.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return bbsim(arguments, folder.path());
  };
  const Result met = run({"--expect", "x.Overshoot < 45 %", "--expect", "rms_x from 5 s >= 3 cm"});
  CHECK(met.exit_code == 0);
  CHECK(met.out.empty());
  CHECK(met.err.empty());
  const Result unmet = run({"--expect", "x.Overshoot<=41", "--expect", "max_tilt < 180 deg",
                            "--expect", "when x=1 m < 3 s", "--measure", "end_x"});
  CHECK(unmet.exit_code == 1);
  CHECK(unmet.out.starts_with("measure,value\nend_x,0.03"));
  CHECK(unmet.out.find("Overshoot") == std::string::npos);
  CHECK(unmet.err.starts_with("not as expected: x.Overshoot<=41: x.Overshoot is 41.1"));
  CHECK(unmet.err.find("max_tilt") == std::string::npos);
  CHECK(unmet.err.find("not as expected: when x=1 m < 3 s: when x=1 cross=1 is not a number: it "
                       "does not happen\n") != std::string::npos);
  const auto summary = nlohmann::json::parse(folder.read("s.json"));
  CHECK(summary["status"] == "done");
  REQUIRE(summary["expectations"].size() == 3);
  CHECK(summary["expectations"][0]["text"] == "x.Overshoot<=41");
  CHECK(summary["expectations"][0]["value"] > 41);
  CHECK(summary["expectations"][0]["holds"] == false);
  CHECK(summary["expectations"][1]["holds"] == true);
  CHECK(summary["expectations"][2]["value"].is_null());
  CHECK(summary["measures"].size() == 1);
  for (const char* wrong : {"max_x", "max_x < 1 deg", "max_z < 1", "max_x from 13 s < 1"}) {
    CAPTURE(wrong);
    const Result refused = run({"--expect", wrong});
    CHECK(refused.exit_code == 2);
    CHECK(refused.err.starts_with("--expect: found "));
  }
}

TEST_CASE("a log that seems to use units other than bbsim's gives a warning") {
  const Folder folder;
  folder.write("log.csv", "t,x,phi,other\n0,0,0,0\n1000,120,5,7\n2000,60,-12,7\n3000,0,0,7\n");
  const Result measured =
      bbsim({"measure", "log.csv", "--measure", "max_x,max_phi,max_other"}, folder.path());
  CHECK(measured.exit_code == 0);
  CHECK(measured.err ==
        "warning: log.csv: x goes up to 120, measured in m: it looks like millimeters or "
        "centimeters\n"
        "warning: log.csv: phi goes up to 12, measured in rad: it looks like degrees\n");
  CHECK(bbsim({"measure", "log.csv", "--measure", "max_other"}, folder.path()).err.empty());
  CHECK(bbsim({"measure", "log.csv", "--measure", "max_x", "-q"}, folder.path()).err.empty());
  // A result of bbsim's is in SI, however large its values.
  const Result far =
      bbsim({"run", config("fig2a.yaml"), "-q", "-o", "far.h5", "--set", "ball.position.0=100"},
            folder.path());
  REQUIRE(far.exit_code == 0);
  CHECK(bbsim({"measure", "far.h5", "--measure", "max_x"}, folder.path()).err.empty());

  folder.write("run.csv", "t,x,phi,other\n0,0,0,0\n1,0.12,0.1,7\n2,0.06,-0.2,7\n3,0,0,7\n");
  const Result compared = bbsim({"compare", "run.csv", "log.csv"}, folder.path());
  CHECK(compared.exit_code == 1);
  CHECK(compared.err ==
        "warning: log.csv: t spans 3000, and in run.csv 3: it looks like milliseconds\n"
        "warning: log.csv: x goes up to 120, and in run.csv 0.12: it looks like millimeters or "
        "centimeters\n"
        "warning: log.csv: phi goes up to 12, and in run.csv 0.2: it looks like degrees\n");
  CHECK(bbsim({"compare", "log.csv", "log.csv"}, folder.path()).err.empty());
  CHECK(bbsim({"compare", "run.csv", "log.csv", "-q"}, folder.path()).err.empty());

  // The same with a table.
  folder.write("s.yaml",
               "ball: {radius: 0.01}\n"
               "gimbal: {motion: {phi: {table: {file: log.csv, time: t, value: phi}}}}\n"
               "time: {end: 3, step: 1}\n");
  const Result run = bbsim({"run", "s.yaml", "-o", "a.csv"}, folder.path());
  CHECK(run.exit_code == 0);
  CHECK(run.err.find("it looks like degrees; say unit: deg") != std::string::npos);
  CHECK(run.err.find("it looks like milliseconds; say time_unit: ms") != std::string::npos);
  const std::string table = "gimbal.motion.phi.table.";
  const Result said = bbsim({"run", "s.yaml", "-o", "b.csv", "--set", table + "unit=deg", "--set",
                             table + "time_unit=ms", "--measure", "max_phi,min_phi"},
                            folder.path());
  CHECK(said.err.find("warning") == std::string::npos);
  CHECK(values_of(said.out).at("min_phi") < -0.2);  // -12 deg, plus interpolation
  CHECK(values_of(said.out).at("min_phi") > -0.3);
}

TEST_CASE("a sweep computes the step metrics of its runs") {
  const Folder folder;
  std::vector<std::string> to_csv{"sweep",     config("step.yaml"),
                                  "--vary",    "controller.pid.kp.0.0=linear:0.6:0.8:3",
                                  "--vary",    "ball.radius=list:0.01,0.02",
                                  "--measure", "x.RiseTime,x.Overshoot,when x=0.02",
                                  "-q",        "-o",
                                  "sweep.csv"};
  const Result result = bbsim(to_csv, folder.path());
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  std::istringstream rows(folder.read("sweep.csv"));
  std::string header, row;
  std::getline(rows, header);
  CHECK(header.ends_with(",end_time,x.RiseTime,x.Overshoot,when x=0.02 cross=1"));
  std::getline(rows, row);
  CAPTURE(row);

  const Result groups = bbsim({"summarize", "sweep.csv", "--by", "ball.radius"}, folder.path());
  CAPTURE(groups.err);
  REQUIRE(groups.exit_code == 0);
  CHECK(groups.out.starts_with("ball.radius,measure,cases,count,mean,deviation,min,q5,q25,q50,"));
  CHECK(groups.out.find("\n0.02,x.Overshoot,3,3,") != std::string::npos);
  CHECK(bbsim({"summarise", "sweep.csv", "--by", "ball.radius"}, folder.path()).out == groups.out);
  CHECK(bbsim({"summarize", "sweep.csv", "--by", "radius"}, folder.path()).exit_code == 2);
  CHECK(bbsim({"summarize", "sweep.csv", "-o", "sweep.csv"}, folder.path()).exit_code == 2);
  CHECK(bbsim({"summarize", "sweep.csv", "--quantiles", "2"}, folder.path()).exit_code == 2);

  // HDF5 agrees, and a resumed sweep recognizes its columns.
  auto to_hdf5 = to_csv;
  to_hdf5.back() = "sweep.h5";
  REQUIRE(bbsim(to_hdf5, folder.path()).exit_code == 0);
  CHECK(bbsim({"compare", "sweep.csv", "sweep.h5"}, folder.path()).exit_code == 0);
}

TEST_CASE("a log is measured with its own names, units and clock") {
  const Folder folder;
  folder.write("log.csv", "10,ok\n20,ok\n40,ok\n");
  const std::vector<std::string> words{"measure",      "log.csv",  "--header", "px,mode",  "--map",
                                       "x=-0.5*px:mm", "--period", "100 ms",   "--measure"};
  auto peak = words;
  peak.emplace_back("min_x,find x at 0.1");
  const Result made = bbsim(peak, folder.path());
  CAPTURE(made.out, made.err);
  CHECK(made.exit_code == 0);
  CHECK(made.out == "measure,value\nmin_x,-0.02\nfind x at 0.1,-0.01\n");
  CHECK(made.err.empty());
  auto aligned = words;
  aligned.insert(aligned.end(), {"min_x", "--time-offset", "auto"});
  CHECK(bbsim(aligned, folder.path()).exit_code == 2);
}

TEST_CASE("run writes derivatives by keys as columns, and gradients of measures") {
  const Folder folder;
  const auto run_to = [&](const std::string& file, const std::string& scene) {
    return bbsim(
        {"run", config(scene), "-q", "-o", file, "--set", "output.columns=[t, x, vx]",
         "--sensitivity", "gravity,ball.radius", "--measure", "end_x", "--summary", "s.json"},
        folder.path());
  };
  const Result run = run_to("by-key.csv", "incline.yaml");
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  const std::string text = folder.read("by-key.csv");
  CHECK(text.substr(0, text.find('\n')) ==
        "t,x,vx,d(x)/d(gravity),d(x)/d(ball.radius),d(vx)/d(gravity),d(vx)/d(ball.radius)");
  const auto summary = nlohmann::json::parse(folder.read("s.json"));
  // x is proportional to gravity.
  CHECK(summary["gradients"]["end_x"]["gravity"].get<double>() ==
        Approx(values_of(run.out).at("end_x") / 9.80665));
  CHECK(std::abs(summary["gradients"]["end_x"]["ball.radius"].get<double>()) < 1e-9);
  CHECK(summary["unreliable"] == nlohmann::json::array());

  CHECK(run_to("by-key.h5", "incline.yaml").exit_code == 0);
  CHECK(bbsim({"compare", "by-key.h5", "by-key.h5"}, folder.path()).exit_code == 0);

  // Rounded measurements step.
  const Result rounded = bbsim({"run", config("rig.yaml"), "-o", "rig.csv", "--sensitivity",
                                "gravity", "--measure", "rms_x", "--summary", "s.json"},
                               folder.path());
  CHECK(rounded.exit_code == 0);
  CHECK(rounded.err.find("unreliable derivatives by gravity: x (from t = ") != std::string::npos);
  CHECK(folder.read("rig.csv").find("nan") == std::string::npos);
  const auto of_rig = nlohmann::json::parse(folder.read("s.json"));
  CHECK(of_rig["gradients"]["rms_x"]["gravity"].is_null());
  const auto& first = of_rig["unreliable"][0];
  CHECK(first["key"] == "gravity");
  CHECK(first["column"] == "x");
  CHECK(first["time"].get<double>() > 0);
  CHECK(of_rig["unreliable"].back() ==
        nlohmann::json{{"key", "gravity"}, {"column", "rms_x"}, {"time", nullptr}});

  const Result refused =
      bbsim({"run", config("incline.yaml"), "-o", "none.csv", "--sensitivity", "time.end"},
            folder.path());
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find("--sensitivity: time.end") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "none.csv"));
}

TEST_CASE("measures of the loop equal linearize's to the last digit") {
  const Folder folder;
  REQUIRE(
      bbsim({"linearize", config("step.yaml"), "-q", "-o", "loop.json"}, folder.path()).exit_code ==
      0);
  const auto loop = nlohmann::json::parse(folder.read("loop.json"));
  const Result run =
      bbsim({"run", config("step.yaml"), "-q", "-o", "step.h5", "--summary", "s.json", "--measure",
             "max_tilt,phi_gain_margin,theta_phase_margin,phi_delay_margin,"
             "y_feedback_bandwidth,stable,phi_gain_reduction",
             "--expect", "phi_delay_margin > 100 ms", "--expect", "phi_phase_margin < 10 deg"},
            folder.path());
  CAPTURE(run.err);
  CHECK(run.exit_code == 1);
  CHECK(run.err.find("not as expected: phi_phase_margin < 10 deg: phi_phase_margin is ") !=
        std::string::npos);
  const auto values = values_of(run.out);
  CHECK(values.at("phi_gain_margin") == loop["margins"]["phi_command"]["gain"]);
  CHECK(values.at("theta_phase_margin") == loop["margins"]["theta_command"]["phase"]);
  CHECK(values.at("phi_delay_margin") == loop["margins"]["phi_command"]["delay"]);
  CHECK(values.at("y_feedback_bandwidth") == loop["feedback_bandwidth"]["y"]);
  CHECK(values.at("stable") == 1);
  CHECK(values.at("max_tilt") > 0);
  const auto summary = nlohmann::json::parse(folder.read("s.json"));
  CHECK(summary["measures"]["phi_delay_margin"] == loop["margins"]["phi_command"]["delay"]);
  CHECK(summary["expectations"][0]["holds"] == true);

  const Result stored =
      bbsim({"measure", "step.h5", "--measure", "phi_delay_margin"}, folder.path());
  CHECK(stored.exit_code == 2);
  CHECK(stored.err.find("which is of the loop and not of a motion") != std::string::npos);
  const auto fault = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", config("fig2b.yaml")});
    const Result refused = bbsim(std::move(more), folder.path());
    CHECK(refused.exit_code == 2);
    return refused.err;
  };
  CHECK(fault({"--measure", "stable from 2 s"})
            .starts_with("measure: found stable from 2 s, which takes no time window; allowed: "));
  CHECK(fault({"--measure", "phi_delay_margn"}).find("did you mean phi_delay_margin?") !=
        std::string::npos);
  CHECK(fault({"--measure", "spectral_radius"}).find("the controller takes no samples") !=
        std::string::npos);
  CHECK(fault({"--measure", "stable", "--sensitivity", "gravity"})
            .find("allowed: measures of the motion") != std::string::npos);
}

}  // namespace bbsim_test::test_measure
