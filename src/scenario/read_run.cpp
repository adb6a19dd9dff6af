// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads `time`, `solver`, `output`, `events` and `sweep`.
#include <algorithm>
#include <set>
#include <string>

#include "base/error.hpp"
#include "scenario/columns.hpp"
#include "scenario/measures.hpp"
#include "scenario/sections.hpp"
#include "scenario/variation.hpp"
#include "yaml/rules.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::scenario {
namespace {

constexpr double most_rows = 1e9;

struct Columns {
  [[nodiscard]] static std::string allowed() { return "a list of columns, such as [t, x, y]"; }
  // Any other name is a number of your own controller, if there is one.
  [[nodiscard]] static yaml::Declared declared() {
    yaml::Declared column(yaml::Declared::Kind::name);
    for (const std::string_view name : column_names()) column.names.emplace_back(name);
    yaml::Declared columns = yaml::Declared::list(
        1, yaml::Declared::unbounded, yaml::Declared::any({column, yaml::Declared::Kind::text}));
    columns.distinct = true;
    return columns;
  }
  [[nodiscard]] static std::string text_of(const std::vector<std::string>& columns) {
    return '[' + joined(columns) + ']';
  }
  static bool read(const yaml::Value& value, std::vector<std::string>& into) {
    if (value.node->kind != yaml::Node::Kind::sequence || value.node->items.empty()) {
      return value.refuse("", allowed());
    }
    into.clear();
    std::set<std::string_view> seen;
    std::size_t own = 0;
    for (std::size_t i = 0; i < value.node->items.size(); ++i) {
      const yaml::Value item = value.item(i);
      const std::string& name = item.node->text;
      if (std::ranges::find(catalogue, name, &Column::name) == catalogue.end()) {
        if (!value.context->own_controller || !is_own_name(name)) {
          yaml::refuse_name(item, column_names());
          continue;
        }
        own_column(name);
        if (++own > most_own_columns) {
          item.refuse(", beside 64 other numbers of the controller's own", "64 of them");
          continue;
        }
      }
      if (!seen.insert(name).second) {
        item.refuse(" again", "each column once");
      } else {
        into.push_back(name);
      }
    }
    return into.size() == value.node->items.size();
  }
};

yaml::NameOf<Method> methods() {
  yaml::NameOf<Method> rule;
  for (const NamedMethod& method : named_methods) {
    rule.choices.push_back({method.method, method.name});
  }
  return rule;
}

// Reports an error bound beside tolerances. If exactly one of them comes from the command line, it
// overrides the other.
void check_bound(yaml::Keys& keys, Solver& solver) {
  const auto on_command_line = [](const yaml::Value& value) { return value.position.source > 0; };
  const yaml::Value error = *keys.find("error");
  for (const char* name : {"rtol", "atol"}) {
    const std::optional<yaml::Value> tolerance = keys.find(name);
    if (!tolerance) continue;
    if (on_command_line(*tolerance) == on_command_line(error)) {
      tolerance->report(
          "given together with error, which chooses the tolerances; allowed: one of them");
    } else if (on_command_line(error)) {
      tolerance->mention("not used: the command line's bound on the error chooses the tolerances");
      solver.rtol = Solver{}.rtol;
      solver.atol = Solver{}.atol;
    } else {
      error.mention("not used: the command line gives tolerances instead");
      solver.error.reset();
    }
  }
}

}  // namespace

void read_time(yaml::Keys& keys, OutputTimes& time) {
  const bool end = keys.required("end", yaml::Number{yaml::Dimension::time, {.above = 0}}, time.end,
                                 {"end of the run"});
  const bool step =
      keys.required("step", yaml::Number{yaml::Dimension::time, {.above = 0}}, time.step,
                    {.meaning = "a row at i × step, exactly, and at the end",
                     .range = "> 0, `end` / 10⁹ or more"});
  if (end) keys.context().end = time.end;
  if (end && step && time.step > time.end) {
    keys.find("step")->warn("is longer than the run, so the result has a row at its start only");
  }
  if (end && step && time.end / time.step > most_rows) {
    keys.find("step")->refuse(", more than 1e9 rows of output",
                              "a time of at least " + number_text(time.end / most_rows));
  }
}

void read_solver(yaml::Keys& keys, Solver& solver) {
  const yaml::Number rtol{yaml::Dimension::number, {.at_least = 1e-14, .at_most = 0.1}, "1e-8"};
  const yaml::Number atol{yaml::Dimension::number, {.above = 0, .at_most = 1}, "1e-10"};
  keys.exclusive({{"error"}, {"rtol", "atol"}});
  keys.optional("method", methods(), solver.method,
                {"`radau`: bbsim's own collocation; `bdf`, `adams`: CVODES; `auto` takes the "
                 "cheapest, which is `radau`"});
  keys.optional("rtol", rtol, solver.rtol, {"local relative tolerance"});
  keys.optional("atol", atol, solver.atol, {"local absolute tolerance", "state's unit"});
  const yaml::Number error{yaml::Dimension::length, {.above = 0, .at_most = 1}, "1e-9"};
  if (keys.optional(
          "error", error, solver.error,
          {"instead of tolerances: a bound on the error of x and y at all output times"}) &&
      solver.error)
    check_bound(keys, solver);
}

void read_output(yaml::Keys& keys, Output& output) {
  keys.optional("columns", Columns{}, output.columns,
                {"[columns](columns.md) of the result, each once"});
}

namespace {

yaml::NameOf<OnEvent> action() {
  return {{{OnEvent::stop, "stop"}, {OnEvent::note, "note"}}};
}

enum class OnSlip { stop, note, slide };

void read_slip(yaml::Keys& keys, SlipEvent& slip) {
  keys.required(
      "friction", yaml::Number{yaml::Dimension::number, {.above = 0}, "0.3"}, slip.friction,
      {"coefficient of static friction: the friction force exceeds it times the normal force"});
  OnSlip action = slip.action == OnEvent::stop ? OnSlip::stop : OnSlip::note;
  keys.optional("action",
                yaml::NameOf<OnSlip>{
                    {{OnSlip::stop, "stop"}, {OnSlip::note, "note"}, {OnSlip::slide, "slide"}}},
                action, {"`slide`: the ball slides: [losses and sliding](#losses-and-sliding)"});
  slip.action = action == OnSlip::stop ? OnEvent::stop : OnEvent::note;
  const yaml::Number sliding{yaml::Dimension::number, {.at_least = 0}, "0.25"};
  std::optional<double> given;
  keys.optional("sliding_friction", sliding, given,
                {.meaning = "coefficient of sliding friction",
                 .standard = "required with `slide`",
                 .range = "0 to `friction`"});
  if (action != OnSlip::slide) return;
  slip.sliding = given.value_or(0);
  if (*slip.sliding > slip.friction && slip.friction > 0) {
    keys.find("sliding_friction")
        ->report(
            "found more than friction, at which the ball starts to slide; allowed: at most "
            "friction");
  }
}

void read_tilt(yaml::Keys& keys, TiltEvent& tilt) {
  keys.required("limit", yaml::angle_limit({.above = 0}), tilt.limit,
                {"the angle between the plate's normal and the vertical exceeds it"});
  keys.optional("action", action(), tilt.action);
}

void read_singularity(yaml::Keys& keys, SingularityEvent& singularity) {
  keys.optional("distance",
                yaml::Number{yaml::Dimension::number, {.above = 0, .at_most = 1}, "0.1"},
                singularity.distance, {"the column `singularity_distance` falls below it"});
  keys.optional("action", action(), singularity.action);
}

}  // namespace

void read_events(yaml::Keys& keys, Events& events) {
  keys.optional("edge", action(), events.edge, {"the contact point leaves the plate"});
  keys.optional("slip", yaml::MappingOf(read_slip), events.slip);
  keys.optional("lift_off", action(), events.lift_off, {"the normal force is no longer positive"});
  keys.optional("tilt", yaml::MappingOf(read_tilt), events.tilt);
  keys.optional("singularity", yaml::MappingOf(read_singularity), events.singularity);
  keys.optional("rest", action(), events.rest,
                {"rolling resistance brings the ball to rest, or holds it at the start"});
  keys.optional(
      "stick", action(), events.stick,
      {"dry friction of its motor holds an axis; recorded as `stick_phi` or `stick_theta`"});
  keys.optional("steps_lost", action(), events.steps_lost,
                {"a stepper with `torque` loses steps; noted, unless this is `stop`"});
}

namespace {

// A mapping from keys of the scenario to the values they take.
struct Variations {
  [[nodiscard]] static std::string allowed() {
    return "a mapping from keys to values, such as ball.radius: linear:0.005:0.02:16";
  }
  [[nodiscard]] static yaml::Declared declared() {
    yaml::Declared variations(yaml::Declared::Kind::names);
    variations.parts.push_back(yaml::Declared::Kind::text);
    return variations;
  }
  static bool read(const yaml::Value& value, std::vector<Variation>& into) {
    if (value.node->kind != yaml::Node::Kind::mapping || value.node->entries.empty()) {
      return value.refuse("", allowed());
    }
    bool fine = true;
    for (const yaml::Entry& entry : value.node->entries) {
      if (entry.value->absent) continue;
      const yaml::Value spec{entry.value, value.path + '.' + entry.key, entry.position,
                             value.context};
      const auto same = [&](const Variation& variation) {
        return yaml::american(variation.key) == yaml::american(entry.key);
      };
      if (spec.node->kind != yaml::Node::Kind::scalar) {
        fine = spec.refuse("", "a text such as linear:0.005:0.02:16");
      } else if (std::ranges::any_of(into, same)) {
        fine = spec.report("found again; allowed: each key once");
      } else {
        into.push_back({entry.key, spec.node->text});
        fine = understood(spec, into.back()) && fine;
      }
    }
    return fine;
  }

 private:
  static bool understood(const yaml::Value& spec, const Variation& variation) {
    try {
      static_cast<void>(parse_variation(variation));
      static_cast<void>(tied_keys(variation));
      return true;
    } catch (const InputError& error) {
      const std::string text = error.what();
      return spec.report(text.substr(text.find(": ") + 2));
    }
  }
};

struct MeasureName {
  [[nodiscard]] static yaml::Declared declared() { return yaml::Declared::Kind::text; }
  static bool read(const yaml::Value& value, std::string& into) {
    into = value.node->text;
    return find_measure(into) || value.refuse(measure_hint(into), allowed_measures());
  }
};
constexpr yaml::ListOf<MeasureName, std::string> measure_names{
    {}, 1, yaml::Declared::unbounded, "measures, such as [max_tilt, end_x]", "each measure once"};

}  // namespace

void read_sweep(yaml::Keys& keys, Sweep& sweep) {
  keys.optional("vary", Variations{}, sweep.vary,
                {"from keys to [value specifications](commands.md#values-of-a-sweep), such as "
                 "`ball.radius: linear:0.005:0.02:16`"});
  keys.optional("combine", yaml::NameOf<Combine>{{{Combine::grid, "grid"}, {Combine::zip, "zip"}}},
                sweep.combine,
                {"`grid`: every combination; `zip`: first values together, then second ones"});
  keys.optional("samples", yaml::Whole{1, "1000"}, sweep.samples,
                {"cases to draw where values are drawn"});
  keys.optional("seed", yaml::Whole{0, "1000"}, sweep.seed, {"seed of drawn values"});
  keys.optional("measure", measure_names, sweep.measure,
                {.meaning = "[measures](measures.md) to keep, such as `max_tilt`, `x.RiseTime`",
                 .standard = "the [default measures](measures.md#default-measures-of-a-sweep)"});
}

}  // namespace bbsim::scenario
