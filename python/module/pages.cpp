// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pages.hpp"

#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/measure.hpp"
#include "api/replay.hpp"
#include "replay/page.hpp"
#include "scenario/reader.hpp"
#include "watch.hpp"

namespace bbsim::python {
namespace {

// Keeps what a command would print.
class Noting : public Watch {
 public:
  std::vector<std::string> notes;
  void note(const std::string& text) override { notes.push_back(text); }
};

struct LogOptions {
  std::vector<std::string> maps, header;
  std::string period, time_offset, missing;

  [[nodiscard]] results::LogChoice choice() const {
    return {maps, header, period, time_offset, missing};
  }
};

struct Page {
  std::string html, reason;  // why a scenario's run ended early
  std::vector<std::string> notes;
};

using Shown = std::variant<std::string, results::Result>;

// `output` is the file that the caller will write, or empty.
Page replay(const std::vector<Shown>& shown, const std::vector<std::string>& logs,
            const LogOptions& log, results::Beside beside, const std::string& title,
            const std::string& output) {
  api::ReplayRequest request;
  for (const Shown& one : shown) {
    if (const auto* const file = std::get_if<std::string>(&one)) {
      request.shown.push_back({*file});
    } else {
      const auto& result = std::get<results::Result>(one);
      request.shown.push_back({result.file.empty() ? "run" : result.file, result});
    }
  }
  request.logs = logs;
  request.log = log.choice();
  request.beside = std::move(beside);
  request.title = title;
  Noting watch;
  Page page = watch.beside([&] {
    const std::string page_template = replay::page_template();
    file::Outputs outputs;
    request.before_running = [&] {
      if (!output.empty()) outputs.writes(output, "output");
    };
    const api::ReplayMade made = api::replay(request, outputs, watch);
    Page its{replay::page(made.scene, page_template), "", {}};
    for (const api::RunResult& run : made.runs) {
      if (its.reason.empty()) its.reason = run.summary.reason;
      its.notes.insert(its.notes.end(), run.summary.warnings.begin(), run.summary.warnings.end());
    }
    return its;
  });
  watch.throw_if_interrupted();
  page.notes.insert(page.notes.end(), watch.notes.begin(), watch.notes.end());
  return page;
}

api::Compared compare(const std::string& a, const std::string& b,
                      const std::vector<std::string>& overrides, std::optional<double> rtol,
                      std::optional<double> atol, const std::vector<std::string>& columns,
                      const LogOptions& log) {
  Noting watch;
  api::Compared made = watch.beside([&] {
    api::CompareRequest request{a, b, rtol, atol, columns, log.choice(), {}};
    if (api::is_scenario(b)) {
      request.run = read_scenario(b, overrides);
    } else if (!overrides.empty()) {
      throw InputError("set: allowed with a scenario as b, in which it sets a key");
    }
    return api::compare(request, watch);
  });
  watch.throw_if_interrupted();
  return made;
}

}  // namespace

void define_pages(py::module_& module) {
  py::class_<LogOptions>(module, "LogOptions")
      .def(py::init([](std::vector<std::string> maps, std::vector<std::string> header,
                       std::string period, std::string time_offset, std::string missing) {
             return LogOptions{std::move(maps), std::move(header), std::move(period),
                               std::move(time_offset), std::move(missing)};
           }),
           py::arg("maps"), py::arg("header"), py::arg("period"), py::arg("time_offset"),
           py::arg("missing"));
  py::class_<Page>(module, "Page")
      .def_readonly("html", &Page::html)
      .def_readonly("reason", &Page::reason)
      .def_readonly("notes", &Page::notes);
  module.def(
      "replay",
      [](const std::vector<Shown>& shown, const std::vector<std::string>& logs,
         const LogOptions& log, std::string summary, std::string scenario,
         std::vector<std::string> overrides, const std::string& title, const std::string& output) {
        return replay(shown, logs, log,
                      {std::move(summary), std::move(scenario), std::move(overrides)}, title,
                      output);
      },
      py::arg("shown"), py::arg("logs"), py::arg("log"), py::arg("summary"), py::arg("scenario"),
      py::arg("overrides"), py::arg("title"), py::arg("output"));
  py::class_<api::Compared>(module, "Compared")
      .def_readonly("alike", &api::Compared::alike)
      .def_readonly("reason", &api::Compared::reason)
      .def_readonly("text", &api::Compared::text)
      .def_readonly("warnings", &api::Compared::warnings);
  module.def("compare", &compare, py::arg("a"), py::arg("b"), py::arg("overrides"), py::arg("rtol"),
             py::arg("atol"), py::arg("columns"), py::arg("log"));
}

}  // namespace bbsim::python
