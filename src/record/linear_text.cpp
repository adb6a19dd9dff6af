// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/linear_text.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"

namespace bbsim::record {
namespace {

using model::LinearSignal;
using model::LinearSystem;
using Signals = std::vector<LinearSignal>;

Json json_of(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(row);
  }
  return rows;
}

Json json_of(const model::Eigenvalues& values) {
  Json list = Json::array();
  for (const auto& value : values) list.push_back({value.real(), value.imag()});
  return list;
}

Json list_of(const Signals& signals, std::string LinearSignal::*what) {
  Json list = Json::array();
  for (const LinearSignal& signal : signals) list.push_back(signal.*what);
  return list;
}

// Infinities are null.
Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string title_of(const LinearReport& report) {
  const LinearSystem& system = report.linearization.system;
  std::string text =
      "The " + report.kind + " of " + printable_ascii(report.scenario) + " about " + report.at;
  if (report.kind == "sampled") text.replace(0, 11, "The sampled plant");
  return text + (system.period
                     ? ", from sample to sample every " + number_text(*system.period) + " s"
                     : ", in continuous time");
}

// Opening comment of a program. The user's names come in the third line: Python and Octave read the
// encoding of a file from the first two, and an encoding can turn comments into code.
std::string opening(const LinearReport& report, const std::string& comment) {
  return comment + " Made by bbsim linearize.\n" + comment +
         " A, B, C and D of a linear system, and its names and units:\n" + comment + ' ' +
         title_of(report) + ".\n";
}

constexpr const char* matrix_names[] = {"A", "B", "C", "D"};

std::array<const Eigen::MatrixXd*, 4> matrices_of(const LinearSystem& system) {
  return {&system.a, &system.b, &system.c, &system.d};
}

// Syntax of a language.
struct Language {
  const char *comment, *before;  // `before`: code at the top
  // Delimiters of a matrix, of its rows and of their numbers.
  const char *open, *open_row, *between, *close_row, *next_row, *close;
  const char *open_list, *close_list, *end;  // `end`: ends a statement
};

std::string text_of(const Eigen::MatrixXd& matrix, const Language& in) {
  std::string text = in.open;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (i > 0) text += in.next_row;
    text += in.open_row;
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      if (j > 0) text += in.between;
      text += number_text(matrix(i, j));
    }
    text += in.close_row;
  }
  return text + in.close;
}

// Statements that set A, B, C, D, the names, the units and the period.
std::string definitions(const LinearReport& report, const Language& in) {
  const LinearSystem& system = report.linearization.system;
  std::string text = opening(report, in.comment) + in.before;
  const auto set = [&](const std::string& name, const std::string& value) {
    text += name + " = " + value + in.end;
  };
  const auto matrices = matrices_of(system);
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    set(matrix_names[i], text_of(*matrices[i], in));
    text += '\n';
  }
  const auto list = [&](const Signals& signals, std::string LinearSignal::*what) {
    std::string items;
    for (const LinearSignal& signal : signals) {
      items += (items.empty() ? "'" : ", '") + signal.*what + "'";
    }
    return in.open_list + items + in.close_list;
  };
  const auto name = [&](const std::string& of, const Signals& signals) {
    set(of + "s", list(signals, &LinearSignal::name));
    text += '\n';
    set(of + "_units", list(signals, &LinearSignal::unit));
    text += '\n';
  };
  name("state", system.states);
  name("input", system.inputs);
  name("output", system.outputs);
  set("period", system.period ? number_text(*system.period) : "0");
  return text + "  " + in.comment + " s; 0 in continuous time\n";
}

Json json_of(const std::vector<model::LoopMargins>& loops) {
  Json all = Json::object();
  for (const model::LoopMargins& loop : loops) {
    const model::Margins& margins = loop.margins;
    Json entry = Json::object();
    entry["gain"] = number_or_null(margins.gain);
    entry["gain_frequency"] = number_or_null(margins.gain_at);
    entry["gain_reduction"] = margins.reduction > 0 ? Json(margins.reduction) : Json(nullptr);
    entry["gain_reduction_frequency"] = number_or_null(margins.reduction_at);
    entry["phase"] = number_or_null(margins.phase);
    entry["phase_frequency"] = number_or_null(margins.phase_at);
    entry["delay"] = number_or_null(margins.delay);
    entry["delay_frequency"] = number_or_null(margins.delay_at);
    all[loop.command] = entry;
  }
  return all;
}

}  // namespace

std::string to_json(const LinearReport& report) {
  const model::Linearization& linearization = report.linearization;
  const LinearSystem& system = linearization.system;
  Json json = Json::object();
  json["scenario"] = report.scenario;
  json["kind"] = report.kind;
  json["at"] = report.at;
  json["states"] = list_of(system.states, &LinearSignal::name);
  json["inputs"] = list_of(system.inputs, &LinearSignal::name);
  json["outputs"] = list_of(system.outputs, &LinearSignal::name);
  json["state_units"] = list_of(system.states, &LinearSignal::unit);
  json["input_units"] = list_of(system.inputs, &LinearSignal::unit);
  json["output_units"] = list_of(system.outputs, &LinearSignal::unit);
  const auto matrices = matrices_of(system);
  for (std::size_t i = 0; i < matrices.size(); ++i) json[matrix_names[i]] = json_of(*matrices[i]);
  json["poles"] = json_of(linearization.poles);
  json["zeros"] = json_of(linearization.zeros);
  json["period"] = system.period ? Json(*system.period) : Json(nullptr);
  if (!linearization.margins.empty()) {
    json["margins"] = json_of(linearization.margins);
    Json bandwidths = Json::object(), of_feedback = Json::object();
    for (const model::Bandwidth& bandwidth : linearization.bandwidths) {
      bandwidths[bandwidth.output] = number_or_null(bandwidth.value);
      of_feedback[bandwidth.output] = number_or_null(bandwidth.of_feedback);
    }
    json["bandwidth"] = bandwidths;
    json["feedback_bandwidth"] = of_feedback;
  }
  return json_text(json, 1) + '\n';
}

std::string margins_json(const model::Linearization& linearization) {
  return json_text(json_of(linearization.margins));
}

std::string to_matlab(const LinearReport& report) {
  constexpr Language matlab{"%", "", "[", "", ", ", "", "; ...\n     ", "]", "{", "}", ";"};
  // Octave knows ss() once its package is loaded.
  return definitions(report, matlab) +
         "if exist('OCTAVE_VERSION', 'builtin') && isempty(which('ss'))\n"
         "  try, pkg load control; catch, end\n"
         "end\n"
         "if ~isempty(which('ss'))\n"
         "  sys = ss(A, B, C, D, period);\n"
         "  set(sys, 'StateName', states, 'InputName', inputs, 'OutputName', outputs);\n"
         "end\n";
}

std::string to_python(const LinearReport& report) {
  constexpr Language python{
      "#", "import numpy\n\n", "numpy.array([", "[", ", ", "]", ",\n    ", "])", "[", "]", ""};
  return definitions(report, python) +
         "\ntry:\n"
         "    import control\n"
         "except ImportError:\n"
         "    pass  # the matrices are all there is\n"
         "else:\n"
         "    sys = control.ss(A, B, C, D, period)\n"
         "    sys.update_names(states=states, inputs=inputs, outputs=outputs)\n";
}

std::string to_csv(const LinearReport& report) {
  const LinearSystem& system = report.linearization.system;
  std::string text = "row";
  for (const Signals* signals : {&system.states, &system.inputs}) {
    for (const LinearSignal& signal : *signals) text += ',' + signal.name;
  }
  text += '\n';
  const auto add = [&](const std::string& name, const Eigen::MatrixXd& left,
                       const Eigen::MatrixXd& right, Eigen::Index i) {
    text += name;
    for (const Eigen::MatrixXd* matrix : {&left, &right}) {
      for (Eigen::Index j = 0; j < matrix->cols(); ++j) text += ',' + number_text((*matrix)(i, j));
    }
    text += '\n';
  };
  for (std::size_t i = 0; i < system.states.size(); ++i) {
    add(system.states[i].name + (system.period ? "_next" : "_dot"), system.a, system.b,
        static_cast<Eigen::Index>(i));
  }
  for (std::size_t i = 0; i < system.outputs.size(); ++i) {
    add(system.outputs[i].name, system.c, system.d, static_cast<Eigen::Index>(i));
  }
  return text;
}

}  // namespace bbsim::record
