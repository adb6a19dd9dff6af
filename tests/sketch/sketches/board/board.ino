// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks on the board what sketches use of it, and prints each failure.
#include <EEPROM.h>
#include <SPI.h>
#include <Servo.h>
#include <Wire.h>

int failures = 0;
#define EXPECT(what) \
  if (!(what)) { \
    failures++; \
    Serial.print(F("line ")); \
    Serial.print(__LINE__); \
    Serial.println(F(": " #what)); \
  }
// Captures printed text.
class Text : public Print {
 public:
  using Print::write;
  size_t write(uint8_t c) override { text += (char)c; return 1; }
  String text;
};
#define PRINTS(arguments, wanted) \
  { \
    Text to; \
    to.print arguments; \
    if (to.text != wanted) { \
      failures++; \
      Serial.print(F("line ")); \
      Serial.print(__LINE__); \
      Serial.println(": " + to.text); \
    } \
  }

const int table[] PROGMEM = {3, 1, 4};
float y0 = 1, y1 = 2, gamma = 3, index = 4, time = 5;  // names that are taken in the C library
Servo s, t;

void numbers() {
  EXPECT(map(512, 0, 1023, 0, 180) == 90);
  EXPECT(map(5, 0, 10, -5.9, 5.9) == 0);
  EXPECT(constrain(7, 0, 5) == 5 && constrain(-1.5, -1.0, 1) == -1.0);
  EXPECT(min(3, 2.5) == 2.5 && max(3, 2.5) == 3 && abs(-2.5) == 2.5 && abs(3u) == 3);
  // Of equal types, of variables, of constants and of literals, as the core's macros.
  float lo = 1.0, two = 2.0;
  int five = 5, seven = 7;
  const long big = 70000;
  unsigned char small = 3;
  EXPECT(max(lo, two) == 2 && min(lo, two) == 1 && max(five, seven) == 7 && min(five, seven) == 5);
  EXPECT(max(2, (int)lo) == 2 && min(2, 3) == 2 && max(2.5, 1.5) == 2.5 && min('a', 'b') == 'a');
  EXPECT(max(big, five) == 70000 && min(big, big) == 70000 && max(small, seven) == 7 && min(small, 2) == 2);
  EXPECT(min(-1, 2.5f) == -1 && max(five, 4.5) == 5 && max(-1L, five) == 5);
  EXPECT(min(String("a"), String("b")) == "a" && max(millis(), 0UL) >= 0);
  EXPECT(max(NAN, 1.0) == 1 && min(NAN, 1.0) == 1);
  PRINTS((max(lo, two)), "2.00");
  PRINTS((min(five, seven)), "5");
  EXPECT(constrain(five, 0, 3) == 3 && constrain(lo, two, 4) == 2 && constrain(big, 0L, 5L) == 5);
  EXPECT(abs(-five) == 5 && abs(-big) == 70000 && abs(lo - two) == 1 && abs((char)-3) == 3);
  PRINTS((round(2.5)), "3");
  PRINTS((round(-2.5)), "-3");
  EXPECT(round(lo) == 1 && round(five) == 5 && sq(two) == 4 && sq(five + 1) == 36);
  EXPECT(radians(two) > 0.03 && degrees(lo) > 57 && map(seven, 0, 10, 0, 100) == 70 && map(big, 0, 100000, 0, 10) == 7);
  EXPECT(bitRead(seven, 1) == 1 && bit(five) == 32 && lowByte(big) == 0x70 && highByte(five) == 0 && makeWord(1, small) == 259);
  long bits = 0;
  bitWrite(bits, 20, 1);
  bitToggle(bits, 0);
  EXPECT(bits == (1L << 20) + 1 && word(513) == 513);
  EXPECT(isAscii('a') && isControl('\n') && isGraph('!') && toUpperCase('a') == 'A' && toAscii(200) == 72);
  EXPECT(sq(3) == 9 && radians(180) == PI && degrees(PI) == 180);
  EXPECT(DEG_TO_RAD * RAD_TO_DEG == 1 && TWO_PI == 2 * PI && HALF_PI == PI / 2);
  byte low = lowByte(0x1234), high = highByte(0x1234);
  EXPECT(low == 0x34 && high == 0x12 && word(high, low) == 0x1234);
  word w = 7;
  boolean on = true;
  EXPECT(w == 7 && on && bitRead(5, 2) == 1 && bit(3) == 8);
  byte flags = 0;
  bitSet(flags, 1);
  bitWrite(flags, 0, 1);
  bitClear(flags, 1);
  EXPECT(flags == 1);
  // The numbers of avr-libc.
  EXPECT(random(1000) == 807 && random(1000) == 249 && random(10, 20) == 13);
  randomSeed(42);
  long first = random(1000);
  randomSeed(42);
  EXPECT(random(1000) == first);
  EXPECT((int)pgm_read_dword(&table[1]) == 1);
  EXPECT(y0 + y1 + gamma + index + time == 15);
}

void texts() {
  String a = "12,-3.5";
  int comma = a.indexOf(',');
  EXPECT(comma == 2 && a.substring(0, comma).toInt() == 12 && a.substring(comma + 1).toFloat() == -3.5);
  EXPECT(String(255, HEX) == "ff" && String(1.005, 1) == "1.0" && String('c') + 1 == "c1");
  a.trim();
  a.replace(",", ";");
  a.toUpperCase();
  EXPECT(a == "12;-3.5" && a.startsWith("12") && a.endsWith("5") && a.length() == 7);
  EXPECT(("x=" + String(3) + F("!")) == "x=3!");
  char buffer[16];
  dtostrf(3.14159, 7, 2, buffer);
  EXPECT(!strcmp(buffer, "   3.14"));
  PRINTS((1.005), "1.00");
  PRINTS((2.5, 0), "3");
  PRINTS((-0.126), "-0.13");
  PRINTS((255, HEX), "FF");
  PRINTS((5, BIN), "101");
  PRINTS((-5), "-5");
  PRINTS(('a'), "a");
  PRINTS((true), "1");
  PRINTS((NAN), "nan");
  PRINTS((5e9), "ovf");
  Serial.printf("%s %d\n", "printf", 7);
}

void pins() {
  pinMode(LED_BUILTIN, OUTPUT);
  digitalWrite(LED_BUILTIN, HIGH);
  EXPECT(digitalRead(LED_BUILTIN) == HIGH);
  pinMode(4, INPUT_PULLUP);
  EXPECT(digitalRead(4) == HIGH);
  EXPECT(digitalRead(7) == 1 && analogRead(A5) == 300 && analogRead(5) == 300);
  analogReadResolution(12);
  EXPECT(analogRead(A5) == 1201);  // 300 of 1023
  analogReadResolution(10);
  analogWrite(3, 128);
  EXPECT(A15 - A0 == 15);
}

void servos() {
  s.attach(9);
  EXPECT(s.attached() && s.read() == 92 && s.readMicroseconds() == 1500);
  s.write(90);
  EXPECT(s.readMicroseconds() == 1472 && s.read() == 90);
  s.write(91);
  EXPECT(s.readMicroseconds() == 1482);  // 10.3 us per degree
  s.write(1610);
  EXPECT(s.readMicroseconds() == 1610);
  s.write(543);  // 180 degrees
  EXPECT(s.readMicroseconds() == 2400);
  t.attach(10, 1000, 2000);
  t.write(90);
  EXPECT(t.readMicroseconds() == 1500);
  t.writeMicroseconds(2400);
  EXPECT(t.readMicroseconds() == 2000);
  t.write(1500);
  s.write(1472);
}

void clocks() {
  unsigned long start = micros();
  delay(20);
  EXPECT(micros() - start >= 20000 && micros() - start < 20020);
  start = micros();
  delayMicroseconds(150);
  analogRead(A5);
  EXPECT(micros() - start >= 262 && micros() - start < 275);
  unsigned long now = millis();
  while (millis() - now < 20)
    ;
  EXPECT(millis() - now == 20);
  // 200 bytes at 9600 baud block the sketch once 64 are buffered.
  Serial1.begin(9600);
  start = micros();
  for (int i = 0; i < 200; i++) Serial1.print(' ');
  EXPECT(micros() - start > 135000 && micros() - start < 150000);
  Serial1.flush();
  EXPECT(micros() - start > 200000);
}

void memory() {
  EXPECT(EEPROM.length() == 64 && EEPROM.read(3) == 255);
  EEPROM.put(8, 1.5f);
  float back = 0;
  EXPECT(EEPROM.get(8, back) == 1.5f && back == 1.5f);
  EEPROM[3] = 4;
  EEPROM.update(3, EEPROM[3] + 1);
  EXPECT(EEPROM.read(3) == 5);
}

void lines() {
  Serial2.begin(115200);
  Serial2.setTimeout(200);
  EXPECT(Serial2.parseFloat() == -50.0f);
  EXPECT(Serial2.parseInt() == 30 && Serial2.parseInt() == 0);
  EXPECT(Serial2.readStringUntil('\n') == ";");
  EXPECT(Serial2.readStringUntil('\n') == "x-50.0y30.0;");
  while (!Serial2.available())
    ;
  EXPECT(Serial2.peek() == 'x' && Serial2.read() == 'x' && Serial2.parseFloat() == -50.0f);
}

void setup() {
  Serial.begin(115200);
  Wire.begin();
  SPI.begin();
  numbers();
  texts();
  pins();
  servos();
  clocks();
  memory();
  lines();
  Serial.println(failures == 0 ? "all is well" : "failures");
}

void loop() {
  Serial.print("loops:");
  Serial.println(millis() / 10 * 10);
  delay(10);
}
