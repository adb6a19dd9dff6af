// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Features of the board, missing features, and messages about faulty sketches, wirings or
// scenarios.
#include <string>
#include <vector>

#include "catch.hpp"
#include "sketch/sketch.hpp"

namespace bbsim_test::test_board {

TEST_CASE("a board has what sketches use, as on real boards") {
  const Sketch sketch("board");
  // Both servos are level; setup() took half a second for serial output and ended before t = 0.
  expect(0,
         sketch.run("--set 'output.columns=[t, phi_command, theta_command, loops]' --set "
                    "time.end=0.1 --set time.step=0.02"),
         {"controller: printf 7\ncontroller: all is well\n"},
         {"t,phi_command,theta_command,loops\n0,0,0,"});
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
  const auto run = [&](const std::string& parts) {
    const std::string wiring = folder.write(
        "wiring.yaml",
        "servos: {phi: {channel: 0}, theta: {channel: 1}, ignored_channels: [2], oscillator: "
        "27e6}\n" +
            parts);
    return sketch.run(
        "--set controller.library.wiring=" + wiring +
        " --set 'output.columns=[t, phi_command, theta_command]' --set time.end=0.02");
  };
  // A step is 132 of 27e6 s; 307 steps are 1500.9 us, 28.9 us above level.
  expect(0,
         run("inputs: {7: 0}\nscreen:\n  four_wire: {x_plus: A0, y_plus: A1, x_minus: A2, y_minus: "
             "A3}\n"
             "  x: {counts: [112, 912], position: [-0.16, 0.16]}\n"
             "  y: {counts: [212, 812], position: [-0.12, 0.12]}\n"),
         {"controller: 636 436 299\n"}, {"\n0,0.0488", ",0.2144"});
  expect(0,
         run("inputs: {7: 1}\nscreen:\n  chip: stmpe610\n"
             "  x: {counts: [300, 3700], position: [-0.16, 0.16]}\n"
             "  y: {counts: [300, 3700], position: [-0.12, 0.12]}\n"),
         {"controller: 1469 2425 64\n"});
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
  const Sketch sketch(text, plain_wiring +
                                "screen:\n  chip: stmpe610\n"
                                "  x: {counts: [300, 3700], position: [-0.16, 0.16]}\n"
                                "  y: {counts: [300, 3700], position: [-0.12, 0.12]}\n");
  // micros() itself takes 2 us.
  expect(0, sketch.run("--set 'output.columns=[t, waited, bits]' --set time.end=0.5"), {},
         {",2002,8\n"});
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
      plain_wiring +
          (chip ? "inputs: {7: 0}\ndistances: {x: {chip: vl53l0x, offset: \"20 cm\", noise: \"0.5 "
                  "mm\"}}\n"
                : "distances: {x: {trigger: 8, echo: 7, offset: \"20 cm\", noise: \"0.5 mm\"}}\n"));
  CAPTURE(style);
  expect(0,
         sketch.run("--set 'ball.position=[-5 cm, 0]' --set 'output.columns=[t, x, distance]' "
                    "--expect 'max_x from 7 s < 1 cm' --expect 'min_x from 7 s > -1 cm' --expect "
                    "'max_distance from 7 s < 0.21'"));
}

TEST_CASE("a global variable that uses the board is refused, with the right place for it") {
  const std::string use = GENERATE("EEPROM.read(0)", "analogRead(A5)", "digitalRead(7)");
  const Sketch sketch(
      "#include <EEPROM.h>\nint start = " + use + ";\nvoid setup() {}\nvoid loop() {}\n",
      plain_wiring);
  expect(2, sketch.run(), {"a global variable uses the board before setup()"});
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
  expect(0, sketch.run("--set time.end=0.02"), {"controller: late\ncontroller: 1!\n"});
}

TEST_CASE("a number that a sketch prints for a column and that is not finite ends the run") {
  const auto [number, told] = GENERATE(table<std::string, std::string>(
      {{"0 * log(0)", "column u is nan"}, {"log(0)", "is inf"}, {"5e9", "is inf"}}));
  const Sketch sketch(
      "void setup() { SerialUSB.begin(115200); }\nvoid loop() {\n  SerialUSB.print(\"v:inf"
      "o u:\");\n  SerialUSB.println(" +
          number + ");\n  delay(20);\n}\n",
      plain_wiring);
  const std::string column = "--set time.end=0.1 --set output.columns=[t,";
  expect(1, sketch.run(column + "u]"), {told});
  expect(2, sketch.run(column + "v]"));  // text, not a number: the column is never printed
}

TEST_CASE("a column is nan before the sketch prints its first number") {
  const Sketch sketch(
      "void setup() { SerialUSB.begin(115200); }\nvoid loop() {\n  delay(50);\n"
      "  SerialUSB.println(\"u:7\");\n}\n",
      plain_wiring);
  expect(0, sketch.run("--set 'output.columns=[t, u]' --set 'time={end: 0.08, step: 20 ms}'"), {},
         {"t,u\n0,nan\n0.02,nan\n", "\n0.08,7\n"});
}

TEST_CASE("a missing board feature is a compiler error with a hint") {
  const Sketch sketch(
      "#include <Wire.h>\n#include <SPI.h>\nvoid tick() {}\nvoid setup() {\n"
      "  attachInterrupt(2, tick, 1);\n  Wire.requestFrom(0x68, 6);\n  SPI.transfer(3);\n"
      "  shiftOut(1, 2, MSBFIRST, 3);\n}\nISR(TIMER1_COMPA_vect) { tick(); }\n"
      "void loop() {}\n",
      plain_wiring, false);
  expect(2, sketch.made,
         {"bbsim: attachInterrupt: no interrupts; call what it would do from loop()",
          "bbsim: Wire: no part of the wiring speaks I2C by bytes",
          "bbsim: SPI: no part of the wiring speaks SPI by bytes",
          "bbsim: shiftOut: no part of the wiring", "bbsim: ISR: no interrupts",
          "own.ino does not compile"});
  CHECK(sketch.files() == std::vector<std::string>{"own.ino", "wiring.yaml"});
}

TEST_CASE("compiler messages show the sketch's own lines, and warnings stay warnings") {
  const auto [text, code, told] = GENERATE(table<std::string, int, std::string>({
      {"void loop() {\n  later();\n  nobody();\n}\nvoid setup() {}\nvoid later() {}\n", 2,
       "own.ino:3:3: error: "},
      {"void loop() {}\nvoid setup() {\n  int unused;\n}\n", 0,
       "own.ino:3:7: warning: unused variable"},
      {"#include <FancySensor.h>\nvoid loop() {}\nvoid setup() {}\n", 2,
       "belongs to a library: name the library's folder with -I"},
  }));
  expect(code, Sketch(text, plain_wiring, false).made, {told});
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
    const std::string wiring =
        folder.write("wiring.yaml", plain_wiring + "inputs: {A0: " + std::to_string(i + 1) + "}\n");
    expect(1, sketch.run("--set controller.library.wiring=" + wiring),
           {"failed at sample 0 (t = 0 s): it returned 1: " + told[i]});
  }
}

TEST_CASE("a screen's pins in another order than the wiring's are refused") {
  const Sketch sketch(
      "#include <TouchScreen.h>\nTouchScreen ts(A0, A2, A1, A3, 300);\nvoid setup() {}\n"
      "void loop() { ts.getPoint(); delay(5); }\n",
      "servos: {phi: {pin: 9}}\nscreen:\n  four_wire: {x_plus: A0, x_minus: A2, y_plus: A1, "
      "y_minus: A3}\n  x: {counts: [0, 1000], position: [-0.1, 0.1]}\n  y: {counts: [0, 1000], "
      "position: [-0.1, 0.1]}\n");
  expect(2, sketch.run(), {"allowed: TouchScreen(x_plus, y_plus, x_minus, y_minus)"});
}

TEST_CASE("a sketch that waits forever is detected", "[slow]") {
  const Sketch sketch("void setup() {}\nvoid loop() { if (millis() > 100) while (1); }\n",
                      plain_wiring);
  expect(1, sketch.run(),
         {"it is in an endless loop: 5 s of processor time without a call that takes time"},
         {"\n0.08,"});  // the rows before it
}

TEST_CASE("a sketch that crashes ends the run with what happened and when") {
  const auto [text, told] = GENERATE(table<std::string, std::string>({
      {"volatile long three = 3, to;\nvoid setup() {}\nvoid loop() { delay(20); to = map(5, three, "
       "3, 0, 1); }\n",
       "it divided an integer by zero"},
      {"int deep(volatile int* n) { volatile int m = *n + 1; return deep(&m) + m; }\n"
       "void setup() {}\nvoid loop() { delay(20); volatile int n = 0; if (deep(&n)) delay(1); }\n",
       "its stack of 1 MB is full"},
      {"void setup() {}\nvoid loop() { delay(20); throw 3; }\n", "it threw an exception"},
      {"void setup() {}\nvoid loop() { delay(20); abort(); }\n", "it called abort()"},
      {"void setup() {}\nint* volatile p;\nvoid loop() { delay(20); *p = 1; }\n",
       "it crashed by signal 11"},
      {"struct Q { Q() { exit(0); } } q;\nvoid setup() {}\nvoid loop() {}\n", "it called exit(0)"},
      {"int* volatile p;\nstruct Q { Q() { *p = 1; } } q;\nvoid setup() {}\nvoid loop() {}\n",
       "it crashed by signal 11"},
  }));
  const Sketch sketch(text, plain_wiring);
  const bool starts = !contains(text, "struct Q");
  const Result run =
      expect(starts ? 1 : 2, sketch.on_rig("run", " -o a.csv --set time.end=1"), {told});
  CHECK(contains(run.err, "(t = 0.02 s)") == starts);
  CHECK(sketch.files().front() == (starts ? "a.csv" : "own.ino"));
  if (starts) CHECK(sketch.read("a.csv").ends_with('\n'));
  expect(starts ? 1 : 2, sketch.on_rig("check"), {told});
}

TEST_CASE("destructors of a sketch and atexit run, and cannot hurt") {
  const Sketch sketch(
      "struct Q { ~Q() { abort(); } } q;\nvoid bye() { int* volatile p = 0; *p = 1; }\n"
      "struct R { R() { atexit(bye); } } r;\nvoid setup() {}\nvoid loop() { delay(20); }\n",
      plain_wiring);
  expect(0, sketch.run());
}

TEST_CASE("counts are those of the sketch's converter, and beyond its bits are refused") {
  const auto sketch = [](const std::string& bits) {
    return Sketch(
        "void setup() { Serial.begin(115200);" + bits +
            " }\nvoid loop() { Serial.print(\"raw:\"); Serial.println(analogRead(A0)); "
            "delay(20); }\n",
        plain_wiring +
            "screen: {voltages: {x: A0, y: A1}, x: {counts: [400, 3600], position: [-0.1, 0.1]}, "
            "y: {counts: [400, 3600], position: [-0.1, 0.1]}}\n");
  };
  const std::string columns = " --set 'output.columns=[t, x, raw]' --set time.end=0.02";
  expect(0, sketch(" analogReadResolution(12);").run(columns), {}, {"\n0,-0.05,1200\n"});
  const Sketch wide = sketch("");
  for (const Result& refused : {wide.run(columns), wide.on_rig("check")}) {
    expect(2, refused, {"screen.x.counts: found 3600 counts, but the sketch reads 10 bits"});
  }
}

TEST_CASE("a column that a sketch does not print, and pins that nothing listens to, are told") {
  const Sketch sketch(
      "void setup() { Serial.begin(115200); pinMode(5, OUTPUT); }\nvoid loop() {\n"
      "  digitalWrite(5, HIGH); Serial.println(\"raw:7\"); delay(5);\n}\n",
      plain_wiring);
  const std::string pin = "drives pin 5, to which nothing is wired";
  const std::string wrong = " --set 'output.columns=[t, raaw]'",
                    unprinted = "output.columns: found raaw, which the sketch never printed";
  expect(2, sketch.on_rig("run", " -o out.csv" + wrong), {unprinted});
  expect(2, sketch.on_rig("check", wrong), {unprinted});
  CHECK_FALSE(contains(sketch.files().front(), "out.csv"));
  const std::string right = " --set time.end=0.5 --set 'output.columns=[t, raw]'";
  const Result run = expect(0, sketch.run(right), {pin, "controller: raw:7\n"});
  CHECK(count(run.err, "\n") < 20);  // of a hundred lines, the first
  expect(0, sketch.run("-q"), {"!raw:7"});
  expect(2, sketch.on_rig("check", right), {pin});
}

TEST_CASE("a scenario unsuitable for a sketch is refused") {
  const Sketch sketch("void setup() {}\nvoid loop() {}\n", plain_wiring);
  for (const auto& [settings, told] :
       {std::pair<std::string, std::string>{
            "--set controller.library.wiring=null",
            "it is a sketch; allowed: with controller.library.wiring"},
        {"--set 'controller.library.parameters={kp: 1}'", "a sketch takes no parameters, found kp"},
        {"--set controller.drives=acceleration --set controller.limit=null --set "
         "gimbal.servo=null",
         "a sketch moves servos; allowed: drives: angle"},
        {"--set controller.library.wiring=/no/such.yaml", "/no/such.yaml: cannot be read"},
        {"--set 'controller.library.file=" BBSIM_EXAMPLE_LIBRARY "'",
         "which is not a sketch; allowed: with a library that bbsim sketch made"}}) {
    expect(2, sketch.run(settings), {told});
  }
  // Input files are not overwritten.
  for (const std::string name : {"sketch.so", "wiring.yaml"}) {
    expect(2, sketch.on_rig("run", " -o " + name));
  }
}

TEST_CASE("the library has a default name, which replaces no other file") {
  const Folder folder;
  folder.write("a.ino", "void setup() {}\nvoid loop() {}\n");
  expect(0, "sketch a.ino", folder, {"a.so: a controller.library\n"});
  expect(0, "sketch a.ino -q", folder);
  folder.write("a.so", "mine\n");
  for (const std::string more : {"a.ino", "a.ino -o a.ino", "b.ino", "a.ino -I nowhere"}) {
    expect(2, "sketch " + more, folder);
  }
  CHECK(folder.read("a.so") == "mine\n");
  expect(0, "sketch a.ino --force -q", folder);
  expect(3, call_with("CXX", "no-such-compiler", "sketch a.ino", folder),
         {"there is no C++ compiler no-such-compiler (CXX)"});
}

}  // namespace bbsim_test::test_board
