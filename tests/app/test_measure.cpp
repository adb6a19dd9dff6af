// Measures on the command line: of a run, of a stored one, of a sweep, and by group.
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "catch.hpp"
#include "process.hpp"
#include "shell.hpp"

using namespace bbsim_test;

namespace {

// Of "measure,value" lines.
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

TEST_CASE("run prints measures of the motion, and measure those of its rows") {
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

  // The summary has the same.
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
    // Rows are 10 ms or less apart.
    CHECK(value == Approx(motion.at(name)).epsilon(0.02));
  }
}

TEST_CASE("measures are refused where they cannot be, with what is allowed") {
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

TEST_CASE("what switches at a run's last instant counts in its greatest and least values") {
  const Folder folder;
  const std::string first_order = "gimbal.servo={time_constant: 0.05}";
  const std::string names =
      "max_tilt_rate,end_tilt_rate,max_motor_torque_theta,end_motor_torque_theta";
  // 10 ms: when the first command comes.
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

TEST_CASE("a log of any rig is measured, whatever its other columns are") {
  const Folder folder;
  folder.write("log.csv", "\"t\",x (m),y,mode\n0,1,2,auto\n1,3,4,man\n");
  CHECK(bbsim({"measure", "log.csv", "--measure", "max_y"}, folder.path()).out ==
        "measure,value\nmax_y,4\n");
  const Result words = bbsim({"measure", "log.csv", "--measure", "max_mode"}, folder.path());
  CHECK(words.exit_code == 2);
  CHECK(words.err.find("column mode, row 1: found \"auto\", a number is expected") !=
        std::string::npos);
  folder.write("words.csv", "t,x,when,at\n0,1,a,b\n1,2,c,d\n2,3,e,f\n");
  CHECK(bbsim({"measure", "words.csv", "--measure", "when x=1.5"}, folder.path()).out ==
        "measure,value\nwhen x=1.5 cross=1,0.4999999999999999\n");
  folder.write("sweep.csv", "case,ball.radius,status,end_x\n0,0.01,done,1\n1,0.02,done,2\n");
  const Result sweep = bbsim({"measure", "sweep.csv", "--measure", "end_x"}, folder.path());
  CHECK(sweep.exit_code == 2);
  CHECK(sweep.err.find("is a sweep") != std::string::npos);
}

TEST_CASE("a sweep takes step metrics, and they are those of its runs") {
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

  const Result groups = bbsim({"summarise", "sweep.csv", "--by", "ball.radius"}, folder.path());
  CAPTURE(groups.err);
  REQUIRE(groups.exit_code == 0);
  CHECK(groups.out.starts_with("ball.radius,measure,cases,count,mean,deviation,min,q5,q25,q50,"));
  CHECK(groups.out.find("\n0.02,x.Overshoot,3,3,") != std::string::npos);
  CHECK(bbsim({"summarise", "sweep.csv", "--by", "radius"}, folder.path()).exit_code == 2);
  CHECK(bbsim({"summarise", "sweep.csv", "-o", "sweep.csv"}, folder.path()).exit_code == 2);
  CHECK(bbsim({"summarise", "sweep.csv", "--quantiles", "2"}, folder.path()).exit_code == 2);

  // HDF5 has the same, and a resumed sweep takes its columns for what they are.
  auto to_hdf5 = to_csv;
  to_hdf5.back() = "sweep.h5";
  REQUIRE(bbsim(to_hdf5, folder.path()).exit_code == 0);
  CHECK(bbsim({"compare", "sweep.csv", "sweep.h5"}, folder.path()).exit_code == 0);
}
