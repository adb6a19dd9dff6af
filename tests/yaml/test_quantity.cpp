// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Quantities: quantities.yaml. Values are compared exactly: powers of ten apply to the decimal
// text, and other units convert with one rounding of the exact product.
#include <yaml-cpp/yaml.h>

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

YAML::Node rows() {
  return YAML::LoadFile(BBSIM_SOURCE_DIR "/tests/yaml/quantities.yaml");
}

std::string text_of(const YAML::Node& row) {
  auto text = row[0].as<std::string>();
  const std::size_t at = text.find("ZEROS");
  return at == std::string::npos ? text : text.replace(at, 5, std::string(400, '0'));
}

Dimension dimension_of(const YAML::Node& row) {
  return bbsim::yaml::dimension_of(row[1].as<std::string>());
}

}  // namespace

TEST_CASE("a quantity is the nearest double in SI units") {
  for (const YAML::Node& row : rows()["read"]) {
    CAPTURE(text_of(row));
    CHECK(plain(text_of(row), dimension_of(row)) == row[2].as<double>());
  }
}

TEST_CASE("a quantity that is none, or out of the range of doubles, has a reason") {
  for (const bool quoted : {true, false}) {
    for (const YAML::Node& row : rows()[quoted ? "quoted" : "plain"]) {
      const std::string said = fault(text_of(row), dimension_of(row), quoted);
      CAPTURE(text_of(row), said);
      const auto expected = row[2].as<std::string>();
      CHECK((expected == "..." ? !said.empty() : said == expected));
    }
  }
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
