// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A program that computes and a sketch that only moves servos, on a serial line.
#include <string>
#include <vector>

#include "catch.hpp"
#include "sketch.hpp"

#ifdef BBSIM_PYTHON

namespace bbsim_test::test_serial {

namespace {

// The start of a program: line 1 of its own is line 4.
const std::string imports = "import sys, time\nsys.path.append('" BBSIM_SOURCE_DIR
                            "/examples/controllers/')\nimport bbsim_serial as serial\n";

const std::string wiring = plain_wiring + "print: all\n";

// A sketch whose loop() is given.
std::string sketch_text(const std::string& loop, const std::string& baud = "9600") {
  return "#include <Servo.h>\nServo phi, theta;\nvoid setup() {\n  Serial.begin(" + baud +
         ");\n  phi.attach(9);\n  theta.attach(10);\n}\nvoid loop() {\n" + loop + "\n}\n";
}

// Runs a sketch with a program at its serial line.
struct Pair : Sketch {
  explicit Pair(const std::string& text, const std::string& program, const std::string& more = "",
                const std::string& wired = wiring)
      : Sketch(text, wired),
        serial(" --set 'controller.library.serial={command: [python3, " +
               write("pc.py", imports + program) + "], timeout: 2, period: \"20 ms\"" + more +
               "}' --set time.end=1 ") {}
  [[nodiscard]] Result talk(const std::string& settings = "") const {
    return run(serial + settings);
  }
  std::string serial;
};

}  // namespace

TEST_CASE("the example of a program and a sketch balances, the same way each time") {
  const Folder folder;
  expect(0, "sketch %examples/controllers/serial/servos.ino -o servos.so", folder);
  const std::string run =
      "run %examples/controllers/serial.yaml -q -o - --set 'controller.library.file=" +
      (folder / "servos.so") +
      "' --expect 'rms_x from 5 s < 2 mm' --expect 'rms_y from 5 s < 2 mm'";
  const Result first = expect(0, run, folder);
  CHECK(call(run, folder).out == first.out);
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
  const Result result = pair.talk("--set 'output.columns=[t, t_ms]'");
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
  const Result result = expect(
      0,
      pair.talk("--set 'output.columns=[t, phi_command, theta_command]' --set events.edge=note"));
  const auto columns = columns_of(result.out);
  CHECK(columns.at("phi_command").back() == Approx(5 * 3.14159265 / 180).epsilon(0.02));
  CHECK(columns.at("theta_command").back() == Approx(-10 * 3.14159265 / 180).epsilon(0.02));
}

TEST_CASE("columns come from the program if it declares them, and else from the sketch") {
  const Sketch sketch(sketch_text("Serial.print(\"loops:\"); Serial.println(3); delay(5);"),
                      wiring);
  const std::string program = sketch.write(
      "pc.py",
      "import json, sys\n"
      "for line in sys.stdin:\n"
      "  m = json.loads(line)\n"
      "  print(json.dumps({'protocol': 1, 'reset': True, 'columns': {'twice': 's'}} if 'protocol' "
      "in m else {'serial': '', 'twice': 2 * m['t']}), flush=True)\n");
  expect(0,
         sketch.run("--set 'controller.library.serial={command: [python3, " + program +
                    "]}' --set time.end=0.2 --set 'output.columns=[t, loops, twice]'"),
         {}, {"\n0.2,3,0.4\n"});
}

TEST_CASE("a fault of the program is told at its sample, and the line's troubles at the end") {
  const std::string read = "while (Serial.available()) Serial.read();";
  const std::string open = "b = serial.Serial('x', 9600)\n";
  const auto [loop, program, told] = GENERATE_COPY(table<std::string, std::string, std::string>({
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
  const Result result = pair.talk("--set controller.library.serial.timeout=0.5");
  CAPTURE(result.err);
  CHECK(contains(result.err, told));
}

TEST_CASE("a program needs a sketch whose line is free, and a command that starts") {
  const std::string camera =
      wiring +
      "camera: {period: 0.03, x: {counts: [0, 1], position: [0, 1]}, y: {counts: [0, 1], "
      "position: [0, 1]}, frame: \"{x}\"}\n";
  expect(2, Pair(sketch_text("delay(1);"), "serial.ball()\n", "", camera).talk(),
         {"controller.library.serial: found beside the camera"});
  expect(2,
         Pair(sketch_text("delay(1);"), "")
             .talk("--set controller.library.serial.command=[/no/such/program]"),
         {"controller.library.serial.command: found"});
}

}  // namespace bbsim_test::test_serial

#endif
