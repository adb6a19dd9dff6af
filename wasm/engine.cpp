// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The engine of a live page, for src/replay/page/engine.js, which calls it in a worker. It takes
// {text, name, set}: the text of a scenario, its name and settings as after --set, with one of
// - {controlled, checked, keys}: a run; whether the page's controller replaces the law, and
//   what to tell beside it;
// - {cases: {keys, columns, measures}}: many runs, each with a value (SI) of {key: [values]};
// - {loops: true}: its open loops;
// - {hand: {from, to, seconds}}: a piece of a motion whose tilt someone leads by hand, from
//   [x, y, vx, vy, phi, theta] to [phi, theta] (SI);
// - {paths: true}: all keys that a scenario may have;
// - {rigs: COUNT}: keys and values of rigs that differ by their tolerances.
#include <emscripten/emscripten.h>

#include <cstdlib>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/sweep.hpp"
#include "api/replay.hpp"
#include "api/assemble.hpp"
#include "api/run.hpp"
#include "base/json.hpp"
#include "replay/page.hpp"
#include "scenario/edit_text.hpp"
#include "scenario/family.hpp"
#include "scenario/keys.hpp"
#include "sweep/window.hpp"

namespace bbsim {
namespace {

struct Answer {
  std::string text;                         // JSON
  std::vector<std::vector<double>> arrays;  // which the JSON names by their places
};
Answer answer;

std::vector<ScenarioFamily::Setting> settings_of(const Json& request) {
  std::vector<ScenarioFamily::Setting> settings;
  for (const auto& [key, value] : request["set"].items()) {
    settings.push_back({key, value.get<std::string>()});
  }
  return settings;
}

Source source_of(const Json& request) {
  Source source{request["name"], request["text"], {}};
  for (const auto& [key, value] : settings_of(request)) {
    source.overrides.push_back(key + '=' + value);
  }
  return source;
}

// The family of the request's text, which most requests share with the one before.
const ScenarioFamily& family_of(const Json& request) {
  static std::unique_ptr<ScenarioFamily> family;
  const std::string &name = request["name"].get_ref<const std::string&>(),
                    &text = request["text"].get_ref<const std::string&>();
  if (!family || family->source().file != name || family->source().text != text) {
    family = std::make_unique<ScenarioFamily>(Source{name, text, {}});
  }
  return *family;
}

Json problems_json(const InputError& error) {
  Json faults = Json::array();
  for (const Problem& problem : error.problems()) {
    faults.push_back({{"place", problem.where}, {"message", problem.message}});
  }
  return {{"faults", faults}};
}

// Asks the page's controller, step(sample) of engine.js. `sample` has its number, the time, whether
// the ball was seen, the ball, the reference and its two derivatives, the servo and its rate, and
// the sampling period. Writes two commands. Returns 0, or 1 if the controller failed: its message
// is in Module.fault.
EM_JS(int, ask_page, (const double* sample, double* commands), {
  return Module.command(HEAPF64.subarray(sample / 8, sample / 8 + 16),
                        HEAPF64.subarray(commands / 8, commands / 8 + 2));
});

EM_JS(char*, page_fault, (), {
  const size = lengthBytesUTF8(Module.fault) + 1;
  const text = _malloc(size);
  stringToUTF8(Module.fault, text, size);
  return text;
});

// A controller that the viewer of the page has written.
class InPage : public model::ExternalController {
 public:
  explicit InPage(double period) : period_(period) {}

  void begin() override {}
  model::Commands command(const model::ControllerSample& of, double* /*own*/) override {
    const api::Sample its = api::copy_of(of);
    const Pair ball = its.ball.value_or(Pair{});
    const double sample[16] = {static_cast<double>(its.number),
                               its.t,
                               its.ball ? 1.0 : 0.0,
                               ball[0],
                               ball[1],
                               its.reference[0],
                               its.reference[1],
                               its.reference_rate[0],
                               its.reference_rate[1],
                               its.reference_acceleration[0],
                               its.reference_acceleration[1],
                               its.servo[0],
                               its.servo[1],
                               its.servo_rate[0],
                               its.servo_rate[1],
                               period_};
    Pair commands{};
    if (ask_page(sample, commands.data()) == 0) return {commands[0], commands[1], 0};
    char* const words = page_fault();
    const std::string fault = words;
    std::free(words);
    throw model::ControllerFault(fault);
  }

 private:
  double period_;  // s
};

Scenario with_controller_of_page(const Scenario& scenario) {
  Scenario its = api::with_outside_commands(scenario);
  its.controller->own->by = ControllerFactory{
      "the controller of this page",
      [](const Scenario& of) { return std::make_shared<InPage>(of.controller->sampling->period); }};
  return its;
}

std::size_t put(std::vector<double> values, std::vector<std::vector<double>>& arrays) {
  arrays.push_back(std::move(values));
  return arrays.size() - 1;
}

// The scenario's own columns, without the row at which an event stopped the run.
Json columns_json(const api::RunResult& result, std::vector<std::vector<double>>& arrays) {
  Json columns = Json::object();
  const std::size_t rows = replay::rows_of_file(*result.pictured);
  for (const std::string& name : result.columns) {
    const std::vector<double>& all = result.pictured->find(name)->numbers;
    columns[name] = put({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(rows)}, arrays);
  }
  return columns;
}

// The scenario with its settings in its text, comments kept, as far as they can be set there; the
// others stay overrides.
Source edited(const Json& request) {
  Source source{request["name"], request["text"], {}};
  for (const ScenarioFamily::Setting& setting : settings_of(request)) {
    try {
      source.text = edited_text(source.text, {setting});
    } catch (const InputError&) {
      source.overrides.push_back(setting.key + '=' + setting.value);
    }
  }
  return source;
}

// A run: what a page shows of it, and its columns.
std::string run(const Json& request, std::vector<std::vector<double>>& arrays) {
  api::RunRequest wanted;
  wanted.scenario = family_of(request).read(settings_of(request));
  wanted.scenario.source = source_of(request);
  if (request["controlled"]) wanted.scenario = with_controller_of_page(wanted.scenario);
  wanted.checked = request["checked"];
  const api::LiveRun live(wanted);
  api::Watch nobody;
  api::RunResult result = api::run(wanted, nobody);
  // As when a controller fails at once.
  if (replay::row_count(*result.pictured) == 0) throw InputError(result.summary.reason);
  Json json;
  json["warnings"] = result.summary.warnings;
  json["columns"] = columns_json(result, arrays);
  replay::Scene scene = api::scene_of(std::move(*result.pictured));
  scene.live = live.of(result, request["keys"]);
  const std::string scene_text = replay::scene_json(scene, arrays);
  const Source in_text = edited(request);
  json["text"] = in_text.text;
  for (const std::string& left : in_text.overrides) {
    json["warnings"].push_back("the text and its file leave out " + left);
  }
  std::string text = json_text(json);
  text.back() = ',';
  return text + "\"scene\":" + scene_text + '}';
}

// Many runs: {status, columns, measures}, each of the latter an array of all cases.
std::string many(const Json& request, std::vector<std::vector<double>>& arrays) {
  const ScenarioFamily family(edited(request));  // a key that varies must not be an override
  const Json& cases = request["cases"];
  api::CasesRequest wanted{family, 0, {}, cases["columns"], cases["measures"]};
  wanted.threads = 1;
  for (const auto& [key, values] : cases["keys"].items()) {
    wanted.keys.push_back({key, values, {}});
    wanted.count = wanted.keys.back().numbers.size();
  }
  api::Watch nobody;
  api::CasesResult result = api::run_cases(wanted, nobody);
  Json json = {
      {"status", Json::array()}, {"columns", Json::object()}, {"measures", Json::object()}};
  for (const auto& [word, reason] : result.status) {
    json["status"].push_back(reason.empty() ? word : word + ": " + reason);
  }
  for (std::size_t i = 0; i < wanted.columns.size(); ++i) {
    json["columns"][wanted.columns[i]] = put(std::move(result.columns[i]), arrays);
  }
  for (std::size_t i = 0; i < wanted.measures.size(); ++i) {
    json["measures"][wanted.measures[i]] = put(std::move(result.measures[i]), arrays);
  }
  return json_text(json);
}

// The state at the end of the piece. The ball, the plate and the mounting are the scenario's; the
// tilt changes at constant rates, whatever moves it in the scenario.
std::string by_hand(const Json& request) {
  const Json& hand = request["hand"];
  const std::vector<double> from = hand["from"], to = hand["to"];
  const double seconds = hand["seconds"];
  api::RunRequest piece;
  Scenario& scenario = piece.scenario;
  scenario = family_of(request).read(settings_of(request));
  scenario.controller.reset();
  const Mounting mounting = scenario.gimbal.mounting;
  scenario.gimbal = Gimbal{};
  scenario.gimbal.mounting = mounting;
  const auto ramp = [&](std::size_t axis) -> Profile {
    return {Ramp{from[4 + axis], (to[axis] - from[4 + axis]) / seconds}};
  };
  scenario.gimbal.motion = GimbalMotion{ramp(0), ramp(1)};
  sweep::remove_events(scenario);
  scenario.ball.position = {from[0], from[1]};
  scenario.ball.velocity = {from[2], from[3]};
  scenario.time = {seconds, seconds};
  scenario.output.columns = {"t",     "x",       "y",       "vx",      "vy",     "phi",
                             "theta", "ball_qw", "ball_qx", "ball_qy", "ball_qz"};
  api::Watch nobody;
  const api::RunResult result = api::run(piece, nobody);
  if (result.code != ExitCode::done) throw InputError(result.summary.reason);
  Json json;
  for (std::size_t i = 0; i < result.columns.size(); ++i) {
    json[result.columns[i]] = result.rows.columns[i].numbers.back();
  }
  return json_text(json);
}

std::string rigs(const Json& request, std::vector<std::vector<double>>& arrays) {
  const ScenarioFamily family(edited(request));
  Json json;
  for (auto& [key, numbers, texts] : api::drawn_rigs(family, request["rigs"])) {
    json["keys"][key] = put(std::move(numbers), arrays);
  }
  return json_text(json);
}

std::string answered(const Json& request, std::vector<std::vector<double>>& arrays) {
  try {
    if (request.contains("cases")) return many(request, arrays);
    if (request.contains("loops")) {
      const Scenario scenario = family_of(request).read(settings_of(request));
      return replay::loops_json(api::loops_of(scenario), arrays);
    }
    if (request.contains("paths")) {
      Json json;
      json["paths"] = scenario::key_paths();
      return json_text(json);
    }
    if (request.contains("hand")) return by_hand(request);
    if (request.contains("rigs")) return rigs(request, arrays);
    return run(request, arrays);
  } catch (const InputError& error) {
    return json_text(problems_json(error));
  } catch (const std::exception& error) {
    return json_text(problems_json(InputError(error.what())));
  }
}

}  // namespace
}  // namespace bbsim

extern "C" {

// Does what the request says. Returns JSON, valid until the next call.
EMSCRIPTEN_KEEPALIVE const char* bbsim_answer(const char* request) {
  using bbsim::answer;
  answer.arrays.clear();
  answer.text = bbsim::answered(bbsim::parse_json(request), answer.arrays);
  return answer.text.c_str();
}

EMSCRIPTEN_KEEPALIVE int bbsim_arrays() {
  return static_cast<int>(bbsim::answer.arrays.size());
}

EMSCRIPTEN_KEEPALIVE const double* bbsim_array(int place) {
  return bbsim::answer.arrays.at(static_cast<std::size_t>(place)).data();
}

EMSCRIPTEN_KEEPALIVE int bbsim_size(int place) {
  return static_cast<int>(bbsim::answer.arrays.at(static_cast<std::size_t>(place)).size());
}
}
