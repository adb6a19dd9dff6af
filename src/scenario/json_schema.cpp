// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The JSON Schema of scenarios, from their declared keys and relations.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "base/json.hpp"
#include "scenario/keys.hpp"
#include "scenario/relations.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::scenario {
namespace {

using yaml::Choice;
using yaml::Declared;
using yaml::DeclaredKey;

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

std::string unit_pattern(yaml::Dimension dimension) {
  std::string units = yaml::unit_names(dimension);
  replace_all(units, ", ", "|");
  replace_all(units, "^2", "(\\^2|²)");
  return units;
}

// A pattern for a number with a unit. It checks only bounds at zero.
std::string pattern_of(const Declared& number) {
  const yaml::Range& range = number.range;
  const bool zero = range.at_least == 0.0 && range.at_most == 0.0;
  const bool positive = range.above >= 0.0 || (range.at_least && *range.at_least > 0);
  const bool negative = !positive && !(range.at_least >= 0.0);
  std::string units = unit_pattern(number.dimension);
  replace_all(units, "um", "[uµμ]m");
  replace_all(units, "us", "[uµμ]s");
  replace_all(units, "deg", "(deg|°)");
  const std::string digits = zero ? "(0+\\.?0*|\\.0+)" : "([0-9]+\\.?[0-9]*|\\.[0-9]+)";
  return std::string("^\\s*") + (negative || zero ? "[-+]?" : "\\+?") +
         (positive ? "(?=[0-9.]*[1-9])" : "") + digits + "([eE][-+]?[0-9]+)?\\s*(" + units +
         ")\\s*$";
}

Json number_schema(const Declared& number) {
  Json schema;
  if (number.dimension == yaml::Dimension::number) {
    schema["type"] = number.whole ? "integer" : "number";
  } else {
    schema["type"] = {"number", "string"};
    schema["pattern"] = pattern_of(number);
  }
  const yaml::Range& range = number.range;
  if (range.above) schema["exclusiveMinimum"] = *range.above;
  if (range.at_least) schema["minimum"] = *range.at_least;
  if (range.at_most) schema["maximum"] = *range.at_most;
  return schema;
}

// Holds if the mapping has the key, in either spelling.
Json has(std::string_view key) {
  Json schema = {{"required", {key}}};
  if (const auto other = yaml::other_spelling(key)) {
    schema = {{"anyOf", {schema, {{"required", {*other}}}}}};
  }
  return schema;
}

Json any_of(std::vector<Json> parts) {
  return parts.size() == 1 ? parts.front() : Json{{"anyOf", std::move(parts)}};
}

Json all_of(std::vector<Json> parts) {
  return parts.size() == 1 ? parts.front() : Json{{"allOf", std::move(parts)}};
}

// The schema of each item.
template <class Items, class Schema>
std::vector<Json> each(const Items& items, const Schema& schema) {
  std::vector<Json> schemas;
  for (const auto& item : items) schemas.push_back(schema(item));
  return schemas;
}

Json has_any(const std::vector<std::string_view>& keys) {
  return any_of(each(keys, has));
}

Json unless(Json schema) {
  return {{"not", std::move(schema)}};
}

// The keys of a group exclude all others. A group that is present needs its required keys.
void add_choice(const Choice& choice, const Declared& mapping, Json& all) {
  std::vector<std::string_view> every;
  for (const auto& group : choice.groups) every.insert(every.end(), group.begin(), group.end());
  if (choice.needed) all.push_back(has_any(every));
  for (const auto& group : choice.groups) {
    std::vector<std::string_view> others;
    std::ranges::copy_if(every, std::back_inserter(others), [&](std::string_view key) {
      return std::ranges::find(group, key) == group.end();
    });
    Json then = Json::array();
    if (!others.empty()) then.push_back(unless(has_any(others)));
    for (const DeclaredKey& key : mapping.keys) {
      if (key.required && std::ranges::find(group, key.name) != group.end()) {
        then.push_back(has(key.name));
      }
    }
    if (!then.empty()) all.push_back({{"if", has_any(group)}, {"then", {{"allOf", then}}}});
  }
}

// The default as JSON. Empty if there is none, or for a list described in words.
std::optional<Json> standard_of(const DeclaredKey& key) {
  if (key.standard.empty()) return {};
  Json value = parse_json(key.standard);
  if (!value.is_discarded()) return value;
  if (key.value.kind == Declared::Kind::list) return {};
  return key.standard;
}

std::string description_of(const DeclaredKey& key) {
  std::string text = plain_meaning(key.about);
  const bool si = key.about.unit.empty() && key.value.kind == Declared::Kind::number;
  const std::string unit(si ? yaml::si_unit(key.value.dimension) : key.about.unit);
  if (!unit.empty() && unit != "-" && unit != "below") text += " (" + unit + ')';
  return text;
}

Json schema_of(const Declared& value);

Json mapping_schema(const Declared& mapping) {
  Json properties = Json::object(), required = Json::array(), all = Json::array();
  for (const DeclaredKey& key : mapping.keys) {
    const std::string& definition = key.value.definition;
    Json schema = definition.empty() ? schema_of(key.value)
                                     : Json{{"allOf", {{{"$ref", "#/definitions/" + definition}}}}};
    if (!key.about.meaning.empty()) schema["description"] = description_of(key);
    if (const auto standard = standard_of(key)) schema["default"] = *standard;
    properties[key.name] = schema;
    if (const auto other = yaml::other_spelling(key.name)) {
      properties[*other] = schema;
      all.push_back(unless({{"required", {key.name, *other}}}));
    }
    if (key.must_be_given() && mapping.choice_of(key.name) == nullptr) {
      required.push_back(key.name);
    }
  }
  for (const Choice& choice : mapping.choices) add_choice(choice, mapping, all);
  for (const auto& groups : mapping.needs) {
    all.push_back(any_of(each(groups, [](const auto& keys) { return all_of(each(keys, has)); })));
  }
  for (const auto& [key, other] : mapping.together) {
    all.push_back({{"if", has(key)}, {"then", has(other)}});
  }
  Json schema = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = required;
  if (!all.empty()) schema["allOf"] = all;
  return schema;
}

Json schema_of(const Declared& value) {
  switch (value.kind) {
    case Declared::Kind::number:
      return number_schema(value);
    case Declared::Kind::text:
      return {{"type", {"string", "number", "boolean"}}, {"minLength", 1}};
    case Declared::Kind::name: {
      Json names = value.names;
      // YAML reads these names as booleans.
      if (std::ranges::count(value.names, "true") > 0) names.insert(names.end(), {true, false});
      return {{"enum", names}};
    }
    case Declared::Kind::unit:
      return {{"type", "string"},
              {"pattern", "^\\s*([µμ°]|" + unit_pattern(value.dimension) + ").*$"}};
    case Declared::Kind::list: {
      Json schema = {
          {"type", "array"}, {"minItems", value.fewest}, {"items", schema_of(value.parts.front())}};
      if (value.most != Declared::unbounded) schema["maxItems"] = value.most;
      if (value.distinct) schema["uniqueItems"] = true;
      return schema;
    }
    case Declared::Kind::mapping:
      return mapping_schema(value);
    case Declared::Kind::names:
      return {{"type", "object"}, {"additionalProperties", schema_of(value.parts.front())}};
    case Declared::Kind::any:
      return {{"anyOf", each(value.parts, [](const Declared& part) { return schema_of(part); })}};
    case Declared::Kind::none:
      break;
  }
  return Json::object();
}

// Applies the schema at a path of keys of a mapping, in either spelling.
Json at(std::string_view path, const Json& schema, bool must_be_there) {
  const std::size_t dot = path.find('.');
  const std::string key(path.substr(0, dot));
  const Json inner =
      dot == std::string_view::npos ? schema : at(path.substr(dot + 1), schema, must_be_there);
  const auto with = [&](const std::string& name) {
    Json outer = Json::object();
    if (!inner.is_null()) outer["properties"] = {{name, inner}};
    if (must_be_there) outer.update({{"type", "object"}, {"required", {name}}});
    return outer;
  };
  const auto other = yaml::other_spelling(key);
  if (!other) return with(key);
  return {{must_be_there ? "anyOf" : "allOf", {with(key), with(*other)}}};
}

Json holds(const Condition& condition) {
  Json value;
  if (!condition.values.empty()) value["enum"] = condition.values;
  if (condition.positive) {
    value = {{"anyOf",
              {{{"type", "number"}, {"exclusiveMinimum", 0}},
               {{"type", "string"}, {"pattern", "^\\s*\\+?[0-9.]*[1-9]"}},
               {{"type", {"object", "array"}}}}}};
  }
  const Json there = at(condition.path, value, true);
  if (!condition.or_absent) return there;
  return {{"anyOf", {there, unless(at(condition.path, nullptr, true))}}};
}

Json hold(std::string_view text) {
  return any_of(each(conditions(text), [](const auto& all) { return all_of(each(all, holds)); }));
}

Json schema_of(const KeyRelation& relation) {
  const Json others = hold(relation.others);
  const Json then = relation.kind == KeyRelation::Kind::needs ? others : unless(others);
  return relation.keys.empty() ? then : Json{{"if", hold(relation.keys)}, {"then", then}};
}

const Declared& declared_at(std::string_view path) {
  const Declared* value = &declared_keys();
  while (!path.empty()) {
    const std::string_view key = path.substr(0, path.find('.'));
    value = &std::ranges::find(value->keys, key, &DeclaredKey::name)->value;
    path.remove_prefix(std::min(key.size() + 1, path.size()));
  }
  return *value;
}

// Limits of commands other than angles have no unit.
Json limit_of_numbers() {
  const Json number = {{"not", {{"type", "string"}}}};
  return {{"if", unless(holds(Condition("controller.drives=angle|legs")))},
          {"then",
           at("controller.limit",
              {{"not", {{"type", "string"}}}, {"properties", {{"phi", number}, {"theta", number}}}},
              false)}};
}

// A number other than 0 is no gain of a law that drives angles.
Json matrices_for_angles() {
  Json gains = Json::array();
  for (const char* path : {"controller.pd.kv", "controller.pd.kp", "controller.pid.kv",
                           "controller.pid.kp", "controller.pid.ki"}) {
    gains.push_back(at(path, {{"anyOf", {{{"type", "array"}}, {{"const", 0}}}}}, false));
  }
  return {{"if", holds(Condition("controller.drives=angle"))}, {"then", {{"allOf", gains}}}};
}

// Only your own controller gives columns other than bbsim's.
Json known_columns() {
  const Declared& columns = declared_at("output.columns");
  const Declared& name = columns.parts.front().parts.front();
  return {{"if", unless(any_of({holds(Condition("controller.program")),
                                holds(Condition("controller.library"))}))},
          {"then", at("output.columns", {{"items", schema_of(name)}}, false)}};
}

}  // namespace

std::string json_schema() {
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", "Scenario of bbsim"}};
  schema.update(schema_of(declared_keys()));
  for (const char* path : {"gimbal.motion.phi", "gimbal.torque.phi", "ball.push.x"}) {
    const Declared& profile = declared_at(path);
    schema["definitions"][profile.definition] = schema_of(profile);
  }
  for (const auto& group : relations()) {
    for (const KeyRelation& relation : group) schema["allOf"].push_back(schema_of(relation));
  }
  schema["allOf"].push_back(limit_of_numbers());
  schema["allOf"].push_back(matrices_for_angles());
  schema["allOf"].push_back(known_columns());
  return json_text(schema, 1);
}

}  // namespace bbsim::scenario
