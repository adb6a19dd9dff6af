// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A program that computes and a sketch that only moves servos, on a serial line.
#include <sstream>
#include <string>
#include <vector>

#include "catch.hpp"
#include "sketch.hpp"

#ifdef BBSIM_PYTHON

namespace bbsim_test::test_serial {

namespace {

const std::string example = std::string(BBSIM_SOURCE_DIR) + "/examples/controllers/";

// The start of a program: line 1 of its own is line 4.
const std::string imports = "import sys, time\nsys.path.append('" + example +
                            "')\n"
                            "import bbsim_serial as serial\n";

const std::string wiring = "servos: {phi: {pin: 9}, theta: {pin: 10}}\nprint: all\n";

// A sketch whose loop() is given.
std::string sketch_text(const std::string& loop, const std::string& baud = "9600") {
  return "#include <Servo.h>\nServo phi, theta;\nvoid setup() {\n  Serial.begin(" + baud +
         ");\n  phi.attach(9);\n  theta.attach(10);\n}\nvoid loop() {\n" + loop + "\n}\n";
}

// Runs a sketch with a program at its serial line.
struct Pair {
  explicit Pair(const std::string& text, const std::string& program, const std::string& more = "",
                const std::string& wired = wiring)
      : sketch(text, wired) {
    REQUIRE(sketch.made.exit_code == 0);
    const std::string file = sketch.folder().write("pc.py", imports + program);
    serial = "controller.library.serial={command: [python3, " + file +
             "], timeout: 2, period: \"20 ms\"" + more + "}";
  }
  [[nodiscard]] Result run(std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {"--set", serial, "--set", "time.end=1", "-o", "-"};
    words.insert(words.end(), more.begin(), more.end());
    return bbsim(sketch.words("run", words));
  }
  Sketch sketch;
  std::string serial;
};

// The numbers of a column, without empty cells.
std::vector<double> column(const std::string& csv, std::size_t index) {
  std::vector<double> numbers;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t i = 0; i <= index; ++i) std::getline(cells, cell, ',');
    numbers.push_back(std::stod(cell));
  }
  return numbers;
}

}  // namespace

TEST_CASE("the example of a program and a sketch balances, the same way each time") {
  const Folder folder;
  REQUIRE(bbsim({"sketch", example + "serial/servos.ino", "-o", folder / "servos.so"}).exit_code ==
          0);
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"run", example + "serial.yaml", "--set",
                                   "controller.library.file=" + (folder / "servos.so"), "-q"};
    words.insert(words.end(), more.begin(), more.end());
    return bbsim(words);
  };
  const Result first = run({"-o", "-"}), again = run({"-o", "-"});
  CAPTURE(first.err);
  REQUIRE(first.exit_code == 0);
  CHECK(first.out == again.out);
  CHECK(run({"-o", folder / "o.csv", "--expect", "rms_x from 5 s < 2 mm", "--expect",
             "rms_y from 5 s < 2 mm"})
            .exit_code == 0);
}

TEST_CASE("bytes take their time on the line, both ways") {
  // 100 bytes at 9600 baud take 104 ms to the sketch, which answers with their number: 6 bytes, 6
  // ms.
  const Pair pair(sketch_text("while (Serial.available()) { if (Serial.read() == 'z') {"
                              " Serial.print(\"t:\"); Serial.println(millis()); } }"),
                  "b = serial.Serial('x', 9600)\n"
                  "serial.ball(); b.write(b'a' * 99 + b'z')\n"
                  "line = b.readline()\n"
                  "print('answer', serial.sample['t'], line, flush=True)\n"
                  "while True: serial.ball()\n",
                  ", delay: \"10 ms\"");
  const Result result = pair.run({"--set", "output.columns=[t, t_ms]"});
  CAPTURE(result.err);
  // 10 ms and 104.2 ms after t = 0, which is at 2 ms of the board's clock (setup: before).
  CHECK(contains(result.err, "t:116"));
  // Its 7 bytes have arrived 7.3 ms later, and the next sample is at 140 ms.
  CHECK(contains(result.err, "answer 0.14 b't:116\\r\\n'"));
}

TEST_CASE("a sketch reads numbers of the line with the functions of Stream") {
  const std::string parse =
      "if (Serial.available() > 0) { int a = Serial.parseInt(); int b = Serial.parseInt();"
      " if (Serial.read() == '\\n') { phi.write(a); theta.write(b); Serial.println(\"ok\"); } }";
  const Pair pair(sketch_text(parse, "115200"),
                  "b = serial.Serial('x', 115200, timeout=0.1)\n"
                  "while True:\n"
                  "  serial.ball(); b.write(b'95,80\\n')\n"
                  "  assert b.readline() == b'ok\\r\\n'\n");
  const Result result = pair.run(
      {"--set", "output.columns=[t, phi_command, theta_command]", "--set", "events.edge=note"});
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(column(result.out, 1).back() == Approx(5 * 3.14159265 / 180).epsilon(0.02));
  CHECK(column(result.out, 2).back() == Approx(-10 * 3.14159265 / 180).epsilon(0.02));
}

TEST_CASE("columns come from the program if it declares them, and else from the sketch") {
  const Sketch sketch(sketch_text("Serial.print(\"loops:\"); Serial.println(3); delay(5);"),
                      wiring);
  REQUIRE(sketch.made.exit_code == 0);
  const std::string program = sketch.folder().write(
      "pc.py",
      "import json, sys\n"
      "for line in sys.stdin:\n"
      "  m = json.loads(line)\n"
      "  print(json.dumps({'protocol': 1, 'reset': True, 'columns': {'twice': 's'}} if 'protocol' "
      "in m else {'serial': '', 'twice': 2 * m['t']}), flush=True)\n");
  const Result result = bbsim(sketch.words(
      "run", {"--set", "controller.library.serial={command: [python3, " + program + "]}", "--set",
              "time.end=0.2", "--set", "output.columns=[t, loops, twice]", "-o", "-"}));
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(contains(result.out, "\n0.2,3,0.4\n"));
}

TEST_CASE("a fault of the program is told at its sample, and the line's troubles at the end") {
  struct Case {
    std::string loop, program, told;
  };
  const std::string read = "while (Serial.available()) Serial.read();";
  const std::string open = "b = serial.Serial('x', 9600)\n";
  const auto [loop, program, told] = GENERATE_COPY(values<Case>({
      {read, open + "for i in range(5): serial.ball(); b.write(b'1')\n",
       "failed at sample 4 (t = 0.08 s): it ended with exit code 0"},
      {read, "serial.ball()\nwhile True: pass\n", "at sample 0 (t = 0 s): it did not answer"},
      {read, "serial.ball()\nserial._say({'serial': '\\u20ac'})\nserial.ball()\n",
       "a character beyond U+00FF"},
      {read, "serial.ball(); serial._answer['serail'] = 'x'\nserial.ball()\n",
       "did you mean serial?"},
      {read, open + "while True: serial.ball(); b.write(b'x' * 2000)\n", "lost"},
      {"delay(1);", open + "while True: serial.ball(); b.write(b'x')\n", "read no byte"},
      {read, open + "while True: serial.ball()\n", "sent no byte"},
      {read, "b = serial.Serial('x', 115200)\nwhile True: serial.ball(); b.write(b'x')\n",
       "at 115200 baud, and the sketch at 9600"},
  }));
  CAPTURE(loop, program);
  const Pair pair(sketch_text(loop), program);
  const Result result = pair.run({"--set", "controller.library.serial.timeout=0.5"});
  CAPTURE(result.err);
  CHECK(contains(result.err, told));
}

TEST_CASE("a program needs a sketch whose line is free, and a command that starts") {
  const std::string camera =
      wiring +
      "camera: {period: 0.03, x: {counts: [0, 1], position: [0, 1]}, y: {counts: [0, 1], "
      "position: [0, 1]}, frame: \"{x}\"}\n";
  const Pair with_camera(sketch_text("delay(1);"), "serial.ball()\n", "", camera);
  const Result refused = with_camera.run();
  CAPTURE(refused.err);
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "controller.library.serial: found beside the camera"));
  const Pair pair(sketch_text("delay(1);"), "");
  const Result unknown =
      pair.run({"--set", "controller.library.serial.command=[/no/such/program]"});
  CHECK(unknown.exit_code == 2);
  CHECK(contains(unknown.err, "controller.library.serial.command: found"));
}

}  // namespace bbsim_test::test_serial

#endif
