// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// docs/reference/scenario.md lists exactly the units that quantities may have.
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "catch.hpp"
#include "yaml/quantity.hpp"

namespace bbsim_test::test_units_in_docs {

using bbsim::yaml::Dimension;
using bbsim::yaml::read_quantity;

namespace {

using Units = std::set<std::string>;

Units split(std::string list) {
  list = list.substr(0, list.find(" ("));
  Units units;
  std::istringstream stream(list);
  for (std::string unit; std::getline(stream, unit, ',');) {
    units.insert(unit.substr(unit.find_first_not_of(' ')));
  }
  return units;
}

// Units by dimension, from the table in the documents.
std::map<std::string, Units> in_docs() {
  std::ifstream docs(std::string(BBSIM_SOURCE_DIR) + "/docs/reference/scenario.md");
  std::map<std::string, Units> table;
  bool among = false;
  for (std::string line; std::getline(docs, line);) {
    if (line == "| dimension | units |") among = true;
    if (among && line.empty()) break;
    if (!among || line.rfind("| ", 0) != 0 || line == "| dimension | units |") continue;
    const std::size_t middle = line.find(" | ");
    table[line.substr(2, middle - 2)] = split(line.substr(middle + 3, line.size() - middle - 5));
  }
  return table;
}

// Units as listed in the message about an unknown unit.
Units in_code(Dimension dimension) {
  const std::string fault = read_quantity("1 parsec", true, dimension).fault;
  const std::size_t begin = fault.find("are: ") + 5;
  return split(fault.substr(begin, fault.rfind(')') - begin));
}

}  // namespace

TEST_CASE("the docs list the units of every dimension") {
  const auto docs = in_docs();
  CHECK(docs.size() == 7);
  CHECK(docs.at("length") == in_code(Dimension::length));
  CHECK(docs.at("mass") == in_code(Dimension::mass));
  CHECK(docs.at("time") == in_code(Dimension::time));
  CHECK(docs.at("angle") == in_code(Dimension::angle));
  CHECK(docs.at("angular rate") == in_code(Dimension::angular_rate));
  CHECK(docs.at("velocity") == in_code(Dimension::velocity));
  CHECK(docs.at("acceleration") == in_code(Dimension::acceleration));
}

}  // namespace bbsim_test::test_units_in_docs
