// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Quantities. Values are compared exactly: powers of ten apply to the decimal text, and other units
// convert with one rounding of the exact product.
#include <clocale>
#include <fstream>
#include <numbers>
#include <string>

#include "base/number_text.hpp"
#include "catch.hpp"
#include "yaml/quantity.hpp"

namespace bbsim_test::test_quantity {

using bbsim::yaml::Dimension;
using bbsim::yaml::read_quantity;

namespace {

constexpr double pi = std::numbers::pi;

double plain(const std::string& text, Dimension dimension) {
  const auto quantity = read_quantity(text, false, dimension);
  INFO(text << quantity.fault);
  REQUIRE(quantity.value);
  return *quantity.value;
}

std::string fault(const std::string& text, Dimension dimension, bool quoted = true) {
  const auto quantity = read_quantity(text, quoted, dimension);
  INFO(text);
  REQUIRE_FALSE(quantity.value);
  return quantity.fault;
}

}  // namespace

TEST_CASE("a quantity is the nearest double in SI units") {
  struct Read {
    std::string text;
    Dimension dimension;
    double value;
  };
  const std::string zeros(400, '0');
  const Read all[] = {
      {"0.01", Dimension::length, 0.01},
      {"-3", Dimension::angle, -3},
      {"+2.5e-3", Dimension::time, 2.5e-3},
      {"1.", Dimension::number, 1},
      {".5", Dimension::number, 0.5},
      {"1E3", Dimension::number, 1000},
      {"0e999999999999999999999", Dimension::number, 0},
      {"0.1000000000000000055511151231257827021181583404541015625", Dimension::number, 0.1},
      {"1" + zeros + "e-400", Dimension::number, 1},
      {"10 cm", Dimension::length, 0.1},
      {"0.1 mm", Dimension::length, 0.0001},
      {"7um", Dimension::length, 7e-6},
      {"7 \u00b5m", Dimension::length, 7e-6},
      {"7 \u03bcm", Dimension::length, 7e-6},
      {"1.1 km", Dimension::length, 1100},
      {"3 nm", Dimension::length, 3e-9},
      {"100 g", Dimension::mass, 0.1},
      {"3 mg", Dimension::mass, 3e-6},
      {"20 ms", Dimension::time, 0.02},
      {"20 ns", Dimension::time, 2e-8},
      {"1e3 us", Dimension::time, 1e-3},
      {"2 min", Dimension::time, 120},
      {"1.5 h", Dimension::time, 5400},
      {"4 mrad", Dimension::angle, 0.004},
      {"10 cm/s", Dimension::velocity, 0.1},
      {"3 mm/s", Dimension::velocity, 0.003},
      {"36 km/h", Dimension::velocity, 10},
      {"981 cm/s^2", Dimension::acceleration, 9.81},
      {"9.81 m/s\u00b2", Dimension::acceleration, 9.81},
      {"12 N", Dimension::force, 12},
      {"5 N cm", Dimension::torque, 0.05},
      {"90 deg", Dimension::angle, pi / 2},
      {"180\u00b0", Dimension::angle, pi},
      {"-45 deg", Dimension::angle, -pi / 4},
      {"1 Hz", Dimension::angular_rate, 2 * pi},
      {"0.5 Hz", Dimension::angular_rate, pi},
      {"500 mHz", Dimension::angular_rate, pi},
      {"0.5 kHz", Dimension::angular_rate, plain("500 Hz", Dimension::angular_rate)},
      {"60 rpm", Dimension::angular_rate, 2 * pi},
      {"90 deg/s", Dimension::angular_rate, pi / 2},
      {"3 mrad/s", Dimension::angular_rate, 0.003},
  };
  for (const Read& one : all) {
    CAPTURE(one.text);
    CHECK(plain(one.text, one.dimension) == one.value);
  }
}

TEST_CASE("a quantity that is none has a reason") {
  CHECK(fault("10 cm", Dimension::time) == ", a length");
  CHECK(fault("3 s", Dimension::angle) == ", a time");
  CHECK(fault("1 m", Dimension::number) == ", a length");
  CHECK(fault("5 N", Dimension::length, false) == ", a force");
  CHECK(fault("10 parsec", Dimension::length) ==
        ", in an unknown unit (units of a length are: m, km, cm, mm, um, nm)");
  CHECK(fault("1 hz", Dimension::angular_rate) ==
        ", in an unknown unit (units of an angular rate are: rad/s, mrad/s, deg/s, Hz, mHz, kHz, "
        "rpm)");
  CHECK(fault("0.01", Dimension::length) == ", a text (drop the quotes or add a unit)");
  CHECK(fault("0.01", Dimension::number) == ", a text (drop the quotes)");
  CHECK(fault("0,01", Dimension::length) == ", with a comma in place of the decimal point");
  for (const char* text : {"nan", ".nan", ".NaN", "inf", "-.inf", "+Infinity"}) {
    CHECK(fault(text, Dimension::length, false) == ", which is not finite");
  }
  for (const char* text : {"", " ", "abc", "e5", ".", "-", "+-1", "cm"}) {
    CHECK(fault(text, Dimension::length, false).empty());
  }
  for (const char* text : {"0x10", "1_000", "1:30", "1 2"}) {
    CHECK_FALSE(fault(text, Dimension::time, false).empty());
  }
}

TEST_CASE("values out of the range of doubles are refused") {
  const std::string large = ", too large for a double (at most 1.8e308)";
  const std::string small = ", too small for a double (0, or at least 2.3e-308 in size)";
  const std::string zeros(400, '0');
  for (const std::string& text : {std::string("1e400"), std::string("-1e400"),
                                  std::string("1e99999999999999999999"), "1" + zeros}) {
    CHECK(fault(text, Dimension::number, false) == large);
  }
  for (const std::string& text :
       {std::string("1e-400"), std::string("1e-320"), "0." + zeros + "1"}) {
    CHECK(fault(text, Dimension::number, false) == small);
  }
  CHECK(fault("1e308 km", Dimension::length) == large);
  CHECK(fault("1e308 Hz", Dimension::angular_rate) == large);
  CHECK(fault("1e-307 mm", Dimension::length) == small);
  CHECK(fault("1e-307 deg", Dimension::angle) == small);
}

TEST_CASE("numbers do not depend on the locale") {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"}) {
    std::setlocale(LC_ALL, name);  // if it is not installed, the locale is unchanged
    CHECK(plain("0.25 cm", Dimension::length) == 0.0025);
    CHECK(bbsim::number_text(0.5) == "0.5");
  }
  std::setlocale(LC_ALL, before.c_str());
}

TEST_CASE("the SI unit of a dimension reads as one") {
  for (const Dimension dimension :
       {Dimension::length, Dimension::mass, Dimension::time, Dimension::angle,
        Dimension::angular_rate, Dimension::velocity, Dimension::acceleration}) {
    const std::string unit(si_unit(dimension));
    CAPTURE(unit);
    CHECK(read_quantity("3 " + unit, true, dimension).value == 3);
  }
  CHECK(si_unit(Dimension::number).empty());
  CHECK(si_unit(Dimension::angular_rate) == "rad/s");
}

TEST_CASE("docs/reference/scenario.md lists the units of each dimension") {
  const Dimension dimension =
      GENERATE(Dimension::length, Dimension::mass, Dimension::time, Dimension::angle,
               Dimension::angular_rate, Dimension::velocity, Dimension::acceleration);
  const std::string noun(bbsim::yaml::noun(dimension));  // "a length"
  const std::string row = "| " + noun.substr(noun.find(' ') + 1) + " | ";
  const std::string units = fault("1 of none", dimension);
  const std::string before = " are: ";
  const auto first = units.find(before) + before.size();
  const std::string listed = units.substr(first, units.rfind(')') - first);

  std::ifstream page(BBSIM_SOURCE_DIR "/docs/reference/scenario.md");
  std::string line, found;
  while (std::getline(page, line)) {
    if (line.starts_with(row)) found = line.substr(row.size());
  }
  found = found.substr(0, found.find(" |"));
  found = found.substr(0, found.find(" ("));  // a remark
  CHECK(found == listed);
}

TEST_CASE("numbers of a file are converted to SI with one rounding") {
  using bbsim::yaml::unit_scale;
  CHECK(unit_scale("cm", Dimension::length)->in_si(10) == 0.1);
  CHECK(unit_scale("mm", Dimension::length)->in_si(0.3) == 0.3 / 1000);
  CHECK(unit_scale("ms", Dimension::time)->in_si(20) == 0.02);
  CHECK(unit_scale("deg", Dimension::angle)->in_si(180) == pi);
  CHECK(unit_scale("\u00b0", Dimension::angle)->in_si(-90) == -pi / 2);
  CHECK(unit_scale("km", Dimension::length)->in_si(1.5) == 1500);
  CHECK(unit_scale("mN m", Dimension::torque)->in_si(5) == 0.005);
  CHECK_FALSE(unit_scale("deg", Dimension::length));
  CHECK_FALSE(unit_scale("", Dimension::length));
}

}  // namespace bbsim_test::test_quantity
