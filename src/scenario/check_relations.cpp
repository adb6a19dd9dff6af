// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks the relations of keys in a scenario (relations.hpp).
#include <algorithm>
#include <optional>
#include <set>

#include "scenario/keys.hpp"
#include "scenario/relations.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::scenario {
namespace {

constexpr std::string_view of_servos = "gimbal.servo.";

// A servo and the path to its keys.
struct ServoAt {
  const Servo* servo;
  std::string path;
};

// The servo of both axes, or of each, and those of legs.
std::vector<ServoAt> all_servos(const Scenario& scenario) {
  const Gimbal& gimbal = scenario.gimbal;
  std::vector<ServoAt> servos;
  if (!gimbal.servo) return servos;
  servos.push_back({&*gimbal.servo, "gimbal.servo.phi"});
  if (gimbal.theta_servo) servos.push_back({&*gimbal.theta_servo, "gimbal.servo.theta"});
  if (!gimbal.three_servos || !gimbal.three_servos->legs) return servos;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& own = (*gimbal.three_servos->legs)[i].servo;
    const std::string path = "gimbal.three_servos.legs." + std::to_string(i) + ".servo";
    if (own) servos.push_back({&*own, path});
  }
  return servos;
}

struct Check {
  const KeyRelation* relation;
  Conditions keys, others;
  bool of_servo;  // holds for each servo
};

std::vector<Check> checks_of(std::span<const KeyRelation> relations) {
  std::vector<Check> checks;
  for (const KeyRelation& relation : relations) {
    checks.push_back({&relation, conditions(relation.keys), conditions(relation.others), false});
    for (const auto& all : checks.back().keys) {
      checks.back().of_servo |= all.front().servo != nullptr;
    }
  }
  return checks;
}

class Checker {
 public:
  Checker(const yaml::Value& root, const Scenario& scenario)
      : root_(root), servos_(all_servos(scenario)), controlled_(scenario.controller.has_value()) {}

  // Reports a broken relation and returns true.
  bool report_if_broken(const Check& check) {
    if (!check.of_servo) {
      servo_ = nullptr;
      return report_one(check);
    }
    bool broken = false;
    for (const ServoAt& servo : servos_) {
      servo_ = &servo;
      broken = (controlled_ && report_one(check)) || broken;
    }
    return broken;
  }

 private:
  bool report_one(const Check& check) {
    if (!hold(check.keys)) return false;
    if (hold(check.others) == (check.relation->kind == KeyRelation::Kind::needs)) return false;
    report(check);
    return true;
  }

  [[nodiscard]] bool hold(const Conditions& any) const {
    return any.empty() || std::ranges::any_of(any, [&](const auto& all) { return hold(all); });
  }
  [[nodiscard]] bool hold(const std::vector<Condition>& all) const {
    return std::ranges::all_of(all, [&](const Condition& condition) { return holds(condition); });
  }
  [[nodiscard]] bool holds(const Condition& condition) const {
    if (const ServoKey* const key = condition.servo) {
      if (servo_ != nullptr) return key->holds(*servo_->servo);
      return std::ranges::any_of(servos_, [&](const ServoAt& at) { return key->holds(*at.servo); });
    }
    const yaml::Node* const node = node_at(condition.path);
    if (node == nullptr) return condition.or_absent;
    if (condition.positive) return is_positive(*node, condition);
    return condition.values.empty() ||
           std::ranges::find(condition.values, node->text) != condition.values.end();
  }
  static bool is_positive(const yaml::Node& node, const Condition& condition) {
    const yaml::Dimension dimension = number_key(condition.path)->dimension;
    const auto number = yaml::read_quantity(node.text, node.quoted, dimension).value;
    return condition.or_absent ? number != 0.0 : number > 0.0;
  }
  // As Value::at(), without the texts of places: a sweep asks for many keys.
  [[nodiscard]] const yaml::Node* node_at(std::string_view path) const {
    const yaml::Node* node = root_.node;
    while (node != nullptr) {
      const std::size_t dot = path.find('.');
      const yaml::Entry* const entry = yaml::entry_of(*node, path.substr(0, dot));
      node = entry == nullptr ? nullptr : entry->value;
      if (dot == std::string_view::npos) break;
      path.remove_prefix(dot + 1);
    }
    return node;
  }

  // Where a key stands; that of a servo with its own keys, with those of all, or in its model.
  [[nodiscard]] std::optional<yaml::Value> place_of(std::string_view path) const {
    if (servo_ == nullptr || !path.starts_with(of_servos)) return root_.at(path);
    const std::string key(path.substr(of_servos.size()));
    for (const std::string& at : {servo_->path + '.' + key, "gimbal.servo." + key,
                                  servo_->path + ".model", std::string("gimbal.servo.model")}) {
      if (auto found = root_.at(at)) return found;
    }
    return root_.at("gimbal.servo");
  }

  void report(const Check& check) {
    std::string_view at = check.relation->at;
    const std::string message = filled(check.relation->message);
    if (const std::size_t colon = at.find(':'); colon != std::string_view::npos) {
      const yaml::Value place = root_.at(at.substr(0, colon)).value_or(root_);
      root_.context->problems.add(place.position,
                                  std::string(at.substr(colon + 1)) + ": " + message);
      return;
    }
    const bool at_value = at.starts_with('=');
    if (at_value) at.remove_prefix(1);
    if (at.empty()) {
      const auto first =
          std::ranges::find_if(check.keys, [&](const auto& all) { return hold(all); });
      at = first->front().path;
    }
    const std::optional<yaml::Value> place = place_of(at);
    if (!place) return;
    const bool is_new = reported_.insert(place->path).second;
    if (!is_new && (check.of_servo || !check.relation->at.empty())) return;
    at_value ? place->report(message) : place->report_at_key(message);
  }

  // The message with the names and values of keys for {...}.
  [[nodiscard]] std::string filled(std::string_view message) const {
    std::string text;
    while (true) {
      const std::size_t open = message.find('{');
      text += message.substr(0, open);
      if (open == std::string_view::npos) return text;
      const std::size_t close = message.find('}', open);
      const std::string_view path = message.substr(open + 1, close - open - 1);
      message.remove_prefix(close + 1);
      const bool value = path.starts_with('=');
      const auto found = root_.at(path.substr(value ? 1 : 0));
      if (found) text += value ? std::string_view(found->node->text) : found->name();
    }
  }

  const yaml::Value& root_;
  std::vector<ServoAt> servos_;
  bool controlled_;
  const ServoAt* servo_ = nullptr;  // the one that is checked
  std::set<std::string> reported_;  // the keys with a message
};

}  // namespace

bool check_relations(const yaml::Value& root, const Scenario& scenario) {
  static const std::array checks{checks_of(relations()[0]), checks_of(relations()[1]),
                                 checks_of(relations()[2])};
  Checker checker(root, scenario);
  const bool clear = std::ranges::none_of(
      checks[0], [&](const Check& check) { return checker.report_if_broken(check); });
  for (std::size_t i = clear ? 1 : 2; i < checks.size(); ++i) {
    for (const Check& check : checks[i]) checker.report_if_broken(check);
  }
  return clear;
}

}  // namespace bbsim::scenario
