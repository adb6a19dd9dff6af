// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Features of the board, missing features, and messages about faulty sketches, wirings or
// scenarios.
#include <algorithm>
#include <string>
#include <vector>

#include "catch.hpp"
#include "sketch/sketch.hpp"

namespace bbsim_test::test_board {

namespace {

const char* const plain_wiring = "servos: {phi: {pin: 9}, theta: {pin: 10}}\n";

}  // namespace

TEST_CASE("a board has what sketches use, as on real boards") {
  const Sketch sketch("board");
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const Result result =
      bbsim(sketch.words("run", {"--set", "output.columns=[t, phi_command, theta_command, loops]",
                                 "--set", "time.end=0.1", "--set", "time.step=0.02", "-o", "-"}));
  CAPTURE(result.err);
  CHECK(result.exit_code == 0);
  CHECK(contains(result.err, "controller: printf 7\ncontroller: all is well\n"));
  // Both servos are level; setup() took half a second for serial output and ended before t = 0.
  CHECK(contains(result.out, "t,phi_command,theta_command,loops\n0,0,0,"));
}

TEST_CASE("screens and a servo driver give their libraries' numbers") {
  const Folder folder;
  const Sketch sketch(
      "#include <Adafruit_PWMServoDriver.h>\n#include <Adafruit_STMPE610.h>\n#include "
      "<TouchScreen.h>\n"
      "Adafruit_PWMServoDriver pwm;\nTouchScreen screen(A0, A1, A2, A3, 300);\n"
      "Adafruit_STMPE610 chip(8);\nvoid loop() { delay(1); }\nvoid setup() {\n"
      "  SerialUSB.begin(115200);\n  pwm.begin();\n  pwm.setOscillatorFrequency(27000000);\n"
      "  pwm.setPWMFreq(50);\n  for (int i = 0; i < 16; i++) pwm.setPWM(i, 0, 4096);\n"
      "  pwm.setPWM(0, 0, 307);\n  pwm.writeMicroseconds(1, 1600);\n  pwm.setPWM(2, 0, 300);\n"
      "  int x, y, z;\n  if (digitalRead(7)) {\n    chip.begin();\n"
      "    TS_Point p = chip.getPoint();\n    x = p.x; y = p.y; z = p.z;\n  } else {\n"
      "    TSPoint p = screen.getPoint();\n    x = p.x; y = p.y; z = p.z;\n  }\n"
      "  SerialUSB.println(String(x) + ' ' + y + ' ' + z);\n}\n",
      plain_wiring);
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const auto run = [&](const std::string& parts) {
    const std::string wiring = folder.write(
        "wiring.yaml",
        "servos: {phi: {channel: 0}, theta: {channel: 1}, ignored_channels: [2], oscillator: "
        "27e6}\n" +
            parts);
    return bbsim(sketch.words("run", {"--set", "controller.library.wiring=" + wiring, "--set",
                                      "output.columns=[t, phi_command, theta_command]", "--set",
                                      "time.end=0.02", "-o", "-"}));
  };
  // A step is 132 of 27e6 s; 307 steps are 1500.9 us, 28.9 us above level.
  const Result wires = run(
      "inputs: {7: 0}\nscreen:\n  four_wire: {x_plus: A0, y_plus: A1, x_minus: A2, y_minus: A3}\n"
      "  x: {counts: [112, 912], position: [-0.16, 0.16]}\n"
      "  y: {counts: [212, 812], position: [-0.12, 0.12]}\n");
  CHECK(contains(wires.err, "controller: 636 436 299\n"));
  CHECK(contains(wires.out, "\n0,0.0488"));
  CHECK(contains(wires.out, ",0.2144"));
  const Result chip =
      run("inputs: {7: 1}\nscreen:\n  chip: stmpe610\n"
          "  x: {counts: [300, 3700], position: [-0.16, 0.16]}\n"
          "  y: {counts: [300, 3700], position: [-0.12, 0.12]}\n");
  CHECK(contains(chip.err, "controller: 1469 2425 64\n"));
}

TEST_CASE("displays and ports without a part print to nowhere, and core headers are there") {
  const std::string text = R"(
#include <Adafruit_SSD1306.h>
#include <Adafruit_STMPE610.h>
#include <LiquidCrystal_I2C.h>
#include <Printable.h>
#include <SoftwareSerial.h>
#include <avr/interrupt.h>
#include <avr/io.h>
#include <pins_arduino.h>
#include <util/delay.h>
LiquidCrystal lcd(12, 11, 5, 4, 3, 2);
LiquidCrystal_I2C second(0x27, 16, 2);
Adafruit_SSD1306 pixels(128, 64, &Wire, -1);
SoftwareSerial other(2, 3);
Adafruit_STMPE610 panel;
long before, waited;
void setup() {
  Serial.begin(115200);
  lcd.begin(16, 2);
  second.init();
  second.backlight();
  other.begin(9600);
  if (!pixels.begin(SSD1306_SWITCHCAPVCC, 0x3C) || !panel.begin()) exit(1);
  pixels.setTextColor(WHITE);
}
void loop() {
  lcd.setCursor(0, 1);
  lcd.print("x = ");
  lcd.println(1.5, 1);
  second.print(F("ready"));
  pixels.clearDisplay();
  pixels.drawCircle(64, 32, 10, SSD1306_WHITE);
  pixels.print(millis());
  pixels.display();
  other.println(B101);
  panel.writeRegister8(STMPE_INT_STA, 0xFF);
  before = micros();
  _delay_ms(1.5);
  _delay_us(500);
  waited = micros() - before;
  Serial.print("waited:");
  Serial.print(waited);
  Serial.print(",bits:");
  Serial.println(B101 + B00000011);
  delay(20);
}
)";
  const Sketch sketch(text, std::string(plain_wiring) +
                                "screen:\n  chip: stmpe610\n"
                                "  x: {counts: [300, 3700], position: [-0.16, 0.16]}\n"
                                "  y: {counts: [300, 3700], position: [-0.12, 0.12]}\n");
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const Result run = bbsim(sketch.words("run", {"--set", "output.columns=[t, waited, bits]",
                                                "--set", "time.end=0.5", "-q", "-o", "-"}));
  CAPTURE(run.err);
  CHECK(run.exit_code == 0);
  CHECK(contains(run.out, ",2002,8\n"));  // micros() itself takes 2 us
}

TEST_CASE("an ultrasonic sensor balances a ball along its axis") {
  const std::string style =
      GENERATE("pulseIn", "polling", "NewPing", "VL53L0X", "Adafruit_VL53L0X");
  const std::string read =
      style == "pulseIn" ? "float us() { ping(); return pulseIn(7, HIGH, 30000); }\n"
      : style == "polling"
          ? "float us() { ping(); while (!digitalRead(7)) {} unsigned long t = micros();\n"
            "  while (digitalRead(7)) {} return micros() - t; }\n"
      : style == "NewPing"
          ? "#include <NewPing.h>\nNewPing sonar(8, 7, 100);\nfloat us() { return sonar.ping(); }\n"
      : style == "VL53L0X"
          ? "#include <VL53L0X.h>\nVL53L0X chip;\nbool on = false;\n"
            "float us() {\n  if (!on) { chip.init(); "
            "chip.setMeasurementTimingBudget(20000); chip.startContinuous(); }\n"
            "  on = true;\n"
            "  return chip.readRangeContinuousMillimeters() * 2e3 / 343;\n}\n"
          : "#include <Adafruit_VL53L0X.h>\nAdafruit_VL53L0X lox;\nbool on = false;\n"
            "float us() {\n  if (!on) on = lox.begin();\n"
            "  VL53L0X_RangingMeasurementData_t m;\n  lox.rangingTest(&m, false);\n"
            "  return m.RangeStatus == 4 ? 0 : m.RangeMilliMeter * 2e3 / 343;\n}\n";
  const bool chip = contains(style, "VL53L0X");
  const Sketch sketch(
      "#include <Servo.h>\nServo phi, theta;\nfloat before = 0.2, filtered = 0;\n"
      "void ping() {\n  digitalWrite(8, LOW); delayMicroseconds(2);\n"
      "  digitalWrite(8, HIGH); delayMicroseconds(10); digitalWrite(8, LOW);\n}\n" +
          read +
          "void setup() {\n  Serial.begin(115200);\n  pinMode(8, OUTPUT);\n  pinMode(7, INPUT);\n"
          "  phi.attach(9);\n  theta.attach(10);\n  theta.write(90);\n  phi.write(90);\n}\n"
          "void loop() {\n  float d = us() / 2e6 * 343;\n"
          "  filtered += 0.5 * ((d - before) / 0.03 - filtered);\n  before = d;\n"
          "  float angle = -(0.7 * (d - 0.2) + 0.5 * filtered);\n"
          "  phi.writeMicroseconds(1472 + angle * 57.3 * 1856 / 180);\n"
          "  Serial.print(\"distance:\");\n  Serial.println(d, 4);\n"
          "  while (millis() % 30 != 0) delayMicroseconds(100);\n}\n",
      std::string(plain_wiring) +
          (chip ? "inputs: {7: 0}\ndistances: {x: {chip: vl53l0x, offset: \"20 cm\", noise: \"0.5 "
                  "mm\"}}\n"
                : "distances: {x: {trigger: 8, echo: 7, offset: \"20 cm\", noise: \"0.5 mm\"}}\n"));
  CAPTURE(style, sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const Result run = bbsim(sketch.words(
      "run", {"--set", "ball.position=[-5 cm, 0]", "--set", "output.columns=[t, x, distance]",
              "--expect", "max_x from 7 s < 1 cm", "--expect", "min_x from 7 s > -1 cm", "--expect",
              "max_distance from 7 s < 0.21", "-q", "-o", "-"}));
  CAPTURE(run.err);
  CHECK(run.exit_code == 0);
}

TEST_CASE("a global variable that uses the board is refused, with the right place for it") {
  const std::string use = GENERATE("EEPROM.read(0)", "analogRead(A5)", "digitalRead(7)");
  const Sketch sketch(
      "#include <EEPROM.h>\nint start = " + use + ";\nvoid setup() {}\nvoid loop() {}\n",
      plain_wiring);
  REQUIRE(sketch.made.exit_code == 0);
  const Result run = bbsim(sketch.words("run", {"-o", "-", "-q"}));
  CHECK(run.exit_code == 2);
  CHECK(contains(run.err, "a global variable uses the board before setup()"));
}

TEST_CASE("nothing is sent before begin(), and find() finds texts that overlap themselves") {
  const Sketch sketch(
      "class Letters : public Stream {\n  const char* at;\n public:\n"
      "  Letters(const char* text) : at(text) {}\n"
      "  int available() override { return strlen(at); }\n"
      "  int read() override { return *at ? *at++ : -1; }\n"
      "  int peek() override { return *at ? *at : -1; }\n"
      "  size_t write(uint8_t) override { return 0; }\n};\n"
      "void loop() { delay(1); }\nvoid setup() {\n  SerialUSB.print(\"early\");\n"
      "  SerialUSB.begin(115200);\n  SerialUSB.println(\"late\");\n"
      "  Letters letters(\"aaab!\");\n  bool found = letters.find(\"aab\");\n"
      "  SerialUSB.println(String(found) + (char)letters.read());\n}\n",
      plain_wiring);
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const Result run = bbsim(sketch.words("run", {"--set", "time.end=0.02", "-o", "-"}));
  CHECK(contains(run.err, "controller: late\ncontroller: 1!\n"));
}

TEST_CASE("a number that a sketch prints for a column and that is not finite ends the run") {
  const auto [number, told] = GENERATE(table<std::string, std::string>(
      {{"0 * log(0)", "column u is nan"}, {"log(0)", "is inf"}, {"5e9", "is inf"}}));
  const Sketch sketch(
      "void setup() { SerialUSB.begin(115200); }\nvoid loop() {\n  SerialUSB.print(\"v:inf"
      "o u:\");\n  SerialUSB.println(" +
          number + ");\n  delay(20);\n}\n",
      plain_wiring);
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const auto run = [&](const std::string& column) {
    return bbsim(sketch.words("run", {"--set", "output.columns=[t, " + column + "]", "--set",
                                      "time.end=0.1", "-o", "-", "-q"}));
  };
  const Result refused = run("u");
  CHECK(refused.exit_code == 1);
  CHECK(contains(refused.err, told));
  CHECK(run("v").exit_code == 2);  // text, not a number: the column is never printed
}

TEST_CASE("a column is nan before the sketch prints its first number") {
  const Sketch sketch(
      "void setup() { SerialUSB.begin(115200); }\nvoid loop() {\n  delay(50);\n"
      "  SerialUSB.println(\"u:7\");\n}\n",
      plain_wiring);
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const Result run = bbsim(sketch.words("run", {"--set", "output.columns=[t, u]", "--set",
                                                "time={end: 0.08, step: 20 ms}", "-o", "-"}));
  CAPTURE(run.err);
  CHECK(run.exit_code == 0);
  CHECK(contains(run.out, "t,u\n0,nan\n0.02,nan\n"));
  CHECK(contains(run.out, "\n0.08,7\n"));
}

TEST_CASE("a missing board feature is a compiler error with a hint") {
  const Sketch sketch(
      "#include <Wire.h>\n#include <SPI.h>\nvoid tick() {}\nvoid setup() {\n"
      "  attachInterrupt(2, tick, 1);\n  Wire.requestFrom(0x68, 6);\n  SPI.transfer(3);\n"
      "  shiftOut(1, 2, MSBFIRST, 3);\n}\nISR(TIMER1_COMPA_vect) { tick(); }\n"
      "void loop() {}\n",
      plain_wiring);
  CAPTURE(sketch.made.err);
  CHECK(sketch.made.exit_code == 2);
  for (const char* hint :
       {"bbsim: attachInterrupt: no interrupts; call what it would do from loop()",
        "bbsim: Wire: no part of the wiring speaks I2C by bytes",
        "bbsim: SPI: no part of the wiring speaks SPI by bytes",
        "bbsim: shiftOut: no part of the wiring", "bbsim: ISR: no interrupts",
        "own.ino does not compile"}) {
    CHECK(contains(sketch.made.err, hint));
  }
  CHECK(sketch.folder().files() == std::vector<std::string>{"own.ino", "wiring.yaml"});
}

TEST_CASE("compiler messages show the sketch's own lines, and warnings stay warnings") {
  const Sketch wrong(
      "void loop() {\n  later();\n  nobody();\n}\nvoid setup() {}\nvoid later() {}\n",
      plain_wiring);
  CHECK(wrong.made.exit_code == 2);
  CHECK(contains(wrong.made.err, "own.ino:3:3: error: "));
  const Sketch warned("void loop() {}\nvoid setup() {\n  int unused;\n}\n", plain_wiring);
  CHECK(warned.made.exit_code == 0);
  CHECK(contains(warned.made.err, "own.ino:3:7: warning: unused variable"));
  const Sketch missing("#include <FancySensor.h>\nvoid loop() {}\nvoid setup() {}\n", plain_wiring);
  CHECK(contains(missing.made.err, "belongs to a library: name the library's folder with -I"));
}

TEST_CASE("a sketch that uses something not in its wiring ends the run, with the remedy") {
  const Folder folder;
  const Sketch sketch(
      "#include <Servo.h>\n#include <EEPROM.h>\n#include <Adafruit_PWMServoDriver.h>\n"
      "Adafruit_PWMServoDriver pwm;\nServo s;\nvoid loop() {}\nvoid setup() {\n"
      "  switch (analogRead(A0)) {\n"
      "    case 1: analogRead(A7); break;\n    case 2: s.attach(3); break;\n"
      "    case 3: analogWrite(9, 10); break;\n    case 4: EEPROM.read(5000); break;\n"
      "    case 5: exit(4);\n    case 6: delay(700000); break;\n"
      "    case 7: digitalWrite(99, 1); break;\n    case 8: pwm.setPWM(2, 0, 300); break;\n  "
      "}\n}\n",
      plain_wiring);
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const std::vector<std::string> told = {
      "analogRead(A7): nothing is wired to pin A7; set a constant in the wiring: inputs: {A7: 512}",
      "Servo.attach(3): no servo is wired to pin 3",
      "analogWrite(9, ...): a servo is wired to pin 9, which needs the pulses of Servo.h",
      "EEPROM: there is no address 5000; allowed: 0 to 1023",
      "it called exit(4)",
      "setup() has not returned within 600 s of the board's clock",
      "digitalWrite(99): there is no such pin",
      "Adafruit_PWMServoDriver.setPWM(2, ...): no servo is wired to channel 2",
  };
  for (std::size_t i = 0; i < told.size(); ++i) {
    const std::string wiring = folder.write(
        "wiring.yaml", plain_wiring + ("inputs: {A0: " + std::to_string(i + 1) + "}\n"));
    const Result result =
        bbsim(sketch.words("run", {"--set", "controller.library.wiring=" + wiring, "-o", "-"}));
    CAPTURE(result.err);
    CHECK(result.exit_code == 1);
    CHECK(contains(result.err, "failed at sample 0 (t = 0 s): it returned 1: " + told[i]));
  }
}

TEST_CASE("a screen's pins in another order than the wiring's are refused") {
  const Sketch sketch(
      "#include <TouchScreen.h>\nTouchScreen ts(A0, A2, A1, A3, 300);\nvoid setup() {}\n"
      "void loop() { ts.getPoint(); delay(5); }\n",
      "servos: {phi: {pin: 9}}\nscreen:\n  four_wire: {x_plus: A0, x_minus: A2, y_plus: A1, "
      "y_minus: A3}\n  x: {counts: [0, 1000], position: [-0.1, 0.1]}\n  y: {counts: [0, 1000], "
      "position: [-0.1, 0.1]}\n");
  const Result result = bbsim(sketch.words("run", {"-o", "-"}));
  CAPTURE(result.err);
  CHECK(result.exit_code == 2);
  CHECK(contains(result.err, "allowed: TouchScreen(x_plus, y_plus, x_minus, y_minus)"));
}

TEST_CASE("a sketch that waits forever is detected", "[slow]") {
  const Sketch sketch("void setup() {}\nvoid loop() { if (millis() > 100) while (1); }\n",
                      plain_wiring);
  const Result result = bbsim(sketch.words("run", {"-o", "-"}));
  CAPTURE(result.err);
  CHECK(result.exit_code == 1);
  CHECK(contains(result.err,
                 "it is in an endless loop: 5 s of processor time without a call that takes time"));
  CHECK(contains(result.out, "\n0.08,"));  // the rows before it
}

TEST_CASE("a sketch that crashes ends the run with what happened and when") {
  struct Crash {
    std::string text, told;
  };
  const Crash crash = GENERATE(
      Crash{"volatile long three = 3, to;\nvoid setup() {}\nvoid loop() { delay(20); to = map(5, "
            "three, 3, 0, 1); }\n",
            "it divided an integer by zero"},
      Crash{"int deep(volatile int* n) { volatile int m = *n + 1; return deep(&m) + m; }\n"
            "void setup() {}\nvoid loop() { delay(20); volatile int n = 0; if (deep(&n)) delay(1); "
            "}\n",
            "its stack of 1 MB is full"},
      Crash{"void setup() {}\nvoid loop() { delay(20); throw 3; }\n", "it threw an exception"},
      Crash{"void setup() {}\nvoid loop() { delay(20); abort(); }\n", "it called abort()"},
      Crash{"void setup() {}\nint* volatile p;\nvoid loop() { delay(20); *p = 1; }\n",
            "it crashed by signal 11"},
      Crash{"struct Q { Q() { exit(0); } } q;\nvoid setup() {}\nvoid loop() {}\n",
            "it called exit(0)"},
      Crash{"int* volatile p;\nstruct Q { Q() { *p = 1; } } q;\nvoid setup() {}\nvoid loop() {}\n",
            "it crashed by signal 11"});
  const Folder folder;
  const Sketch sketch(crash.text, plain_wiring);
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const bool starts = crash.text.find("struct Q") == std::string::npos;
  const Result run =
      bbsim(sketch.words("run", {"-o", folder / "a.csv", "--set", "time.end=1"}), folder.path());
  CAPTURE(run.err);
  CHECK(run.exit_code == (starts ? 1 : 2));
  CHECK(contains(run.err, crash.told));
  CHECK(contains(run.err, "(t = 0.02 s)") == starts);
  CHECK(folder.files() ==
        (starts ? std::vector<std::string>{"a.csv"} : std::vector<std::string>{}));
  if (starts) CHECK(folder.read("a.csv").ends_with('\n'));
  const Result check = bbsim(sketch.words("check"));
  CAPTURE(check.err, check.out);
  CHECK(check.exit_code == run.exit_code);
  CHECK(contains(check.err, crash.told));
}

TEST_CASE("destructors of a sketch and atexit run, and cannot hurt") {
  const Sketch sketch(
      "struct Q { ~Q() { abort(); } } q;\nvoid bye() { int* volatile p = 0; *p = 1; }\n"
      "struct R { R() { atexit(bye); } } r;\nvoid setup() {}\nvoid loop() { delay(20); }\n",
      plain_wiring);
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  CHECK(bbsim(sketch.words("run", {"-o", "-", "-q"})).exit_code == 0);
}

TEST_CASE("counts are those of the sketch's converter, and beyond its bits are refused") {
  const auto reads = [](const std::string& bits) {
    return "void setup() { Serial.begin(115200);" + bits +
           " }\nvoid loop() { Serial.print(\"raw:\"); Serial.println(analogRead(A0)); "
           "delay(20); }\n";
  };
  const std::string wiring =
      plain_wiring + std::string(
                         "screen: {voltages: {x: A0, y: A1}, x: {counts: [400, 3600], "
                         "position: [-0.1, 0.1]}, y: {counts: [400, 3600], position: "
                         "[-0.1, 0.1]}}\n");
  const std::vector<std::string> words{
      "-o", "-", "-q", "--set", "output.columns=[t, x, raw]", "--set", "time.end=0.02"};
  const Sketch fine(reads(" analogReadResolution(12);"), wiring);
  const Result run = bbsim(fine.words("run", words));
  CAPTURE(run.err);
  CHECK(run.exit_code == 0);
  CHECK(contains(run.out, "\n0,-0.05,1200\n"));
  const Sketch wide(reads(""), wiring);
  for (const char* const command : {"run", "check"}) {
    const Result refused = bbsim(
        wide.words(command, std::string(command) == "run" ? words : std::vector<std::string>{}));
    CAPTURE(refused.err);
    CHECK(refused.exit_code == 2);
    CHECK(
        contains(refused.err, "screen.x.counts: found 3600 counts, but the sketch reads 10 bits"));
  }
}

TEST_CASE("a column that a sketch does not print, and pins that nothing listens to, are told") {
  const Sketch sketch(
      "void setup() { Serial.begin(115200); pinMode(5, OUTPUT); }\nvoid loop() {\n"
      "  digitalWrite(5, HIGH); Serial.println(\"raw:7\"); delay(5);\n}\n",
      plain_wiring);
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const auto with = [&](const std::string& command, const std::string& column) {
    std::vector<std::string> more{"--set", "output.columns=[t, " + column + "]", "--set",
                                  "time.end=0.5"};
    if (command == "run") more.insert(more.end(), {"-o", sketch.folder() / "out.csv"});
    return bbsim(sketch.words(command, more));
  };
  for (const char* const command : {"run", "check"}) {
    const Result wrong = with(command, "raaw");
    CAPTURE(wrong.err);
    CHECK(wrong.exit_code == 2);
    CHECK(contains(wrong.err, "output.columns: found raaw, which the sketch never printed"));
  }
  CHECK_FALSE(contains(sketch.folder().files().back(), "out.csv"));
  const Result run = with("run", "raw");
  CHECK(run.exit_code == 0);
  CHECK(contains(run.err, "drives pin 5, to which nothing is wired"));
  // Of a hundred lines, the first are shown; none with -q.
  CHECK(contains(run.err, "controller: raw:7\n"));
  CHECK(std::count(run.err.begin(), run.err.end(), '\n') < 20);
  CHECK_FALSE(contains(bbsim(sketch.words("run", {"-o", "-", "-q"})).err, "raw:7"));
  const Result check = with("check", "raw");
  CHECK(check.exit_code == 2);
  CHECK(contains(check.err, "drives pin 5, to which nothing is wired"));
}

TEST_CASE("a scenario unsuitable for a sketch is refused") {
  const Sketch sketch("void setup() {}\nvoid loop() {}\n", plain_wiring);
  struct Wrong {
    std::vector<std::string> settings;
    std::string told;
  };
  const std::vector<Wrong> all = {
      {{"controller.library.wiring=null"},
       "it is a sketch; allowed: with controller.library.wiring"},
      {{"controller.library.parameters={kp: 1}"}, "a sketch takes no parameters, found kp"},
      {{"controller.drives=acceleration", "controller.limit=null", "gimbal.servo=null"},
       "a sketch moves servos; allowed: drives: angle"},
      {{"controller.library.wiring=/no/such.yaml"}, "/no/such.yaml: cannot be read"},
      {{std::string("controller.library.file=") + BBSIM_EXAMPLE_LIBRARY},
       "which is not a sketch; allowed: with a library that bbsim sketch made"},
  };
  for (const Wrong& one : all) {
    std::vector<std::string> more{"-o", "-"};
    for (const std::string& setting : one.settings) more.insert(more.end(), {"--set", setting});
    const Result result = bbsim(sketch.words("run", more));
    CAPTURE(one.told, result.err);
    CHECK(result.exit_code == 2);
    CHECK(contains(result.err, one.told));
  }
  // Input files are not overwritten.
  for (const char* name : {"sketch.so", "wiring.yaml"}) {
    CHECK(bbsim(sketch.words("run", {"-o", sketch.folder() / name})).exit_code == 2);
  }
}

TEST_CASE("the library has a default name, which replaces no other file") {
  const Folder folder;
  folder.write("a.ino", "void setup() {}\nvoid loop() {}\n");
  CHECK(bbsim({"sketch", "a.ino"}, folder.path()).err == "a.so: a controller.library\n");
  CHECK(bbsim({"sketch", "a.ino", "-q"}, folder.path()).exit_code == 0);
  folder.write("a.so", "mine\n");
  const Result kept = bbsim({"sketch", "a.ino"}, folder.path());
  CHECK(kept.exit_code == 2);
  CHECK(folder.read("a.so") == "mine\n");
  CHECK(bbsim({"sketch", "a.ino", "--force", "-q"}, folder.path()).exit_code == 0);
  CHECK(bbsim({"sketch", "a.ino", "-o", "a.ino"}, folder.path()).exit_code == 2);
  CHECK(bbsim({"sketch", "b.ino"}, folder.path()).exit_code == 2);
  CHECK(bbsim({"sketch", "a.ino", "-I", "nowhere"}, folder.path()).exit_code == 2);
  Launch launch{{"sketch", "a.ino"}, folder.path(), 0, {}, {}, {}};
  launch.prepare = [] { setenv("CXX", "no-such-compiler", 1); };
  const Result without = bbsim(launch);
  CHECK(without.exit_code == 3);
  CHECK(contains(without.err, "there is no C++ compiler no-such-compiler (CXX)"));
}

}  // namespace bbsim_test::test_board
