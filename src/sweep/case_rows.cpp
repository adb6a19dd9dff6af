// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/case_rows.hpp"

#include "file/csv_fields.hpp"
#include "file/hdf5_table.hpp"
#include "sweep/task.hpp"

namespace bbsim::sweep {
namespace {

// Whether an expectation holds in case `i` of the results. It does not if the case has no value.
bool holds(const SweepTask& task, const CaseResults& results, std::size_t i,
           std::size_t expectation) {
  const std::size_t numbers = 1 + task.measures.size();
  return task.expectations[expectation].holds(
      results.numbers[i * numbers + 1 + task.expected[expectation]]);
}

// Calls number(value) or text(value) for each column of case `i`, from the second one to the
// series.
template <class Number, class Text>
void for_each_cell(const SweepTask& task, const CaseResults& results, std::size_t i, Number number,
                   Text text) {
  const auto& axes = task.plan.axes();
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const double value = results.values[i * axes.size() + a];
    axes[a].numeric ? number(value) : text(axes[a].texts[static_cast<std::size_t>(value)]);
  }
  text(results.status[i].word);
  text(results.status[i].reason);
  const std::size_t numbers = 1 + task.measures.size();
  for (std::size_t n = 0; n < numbers; ++n) number(results.numbers[i * numbers + n]);
  for (std::size_t e = 0; e < task.expectations.size(); ++e) {
    number(holds(task, results, i, e) ? 1.0 : 0.0);
  }
}

}  // namespace

void write_rows(const SweepTask& task, CaseResults& results) {
  std::string& line = results.text;
  line.clear();
  for (std::size_t i = 0; i < results.count; ++i) {
    line += std::to_string(results.first + i);
    for_each_cell(
        task, results, i,
        [&line](double value) {
          line += ',';
          file::append_number(line, value);
        },
        [&line](const std::string& text) {
          line += ',';
          file::append_text(line, text);
        });
    line += '\n';
  }
}

void append_rows(const SweepTask& task, const CaseResults& results, file::Hdf5Block& block) {
  const std::size_t cells =
      4 + task.plan.axes().size() + task.measures.size() + task.expectations.size();
  block.values.resize(cells + results.series.size());
  block.texts.resize(cells + results.series.size());
  for (std::size_t i = 0; i < results.count; ++i) {
    std::size_t c = 0;
    block.values[c++].push_back(static_cast<double>(results.first + i));
    for_each_cell(
        task, results, i, [&](double value) { block.values[c++].push_back(value); },
        [&](const std::string& text) { block.texts[c++].push_back(text); });
  }
  for (std::size_t s = 0; s < results.series.size(); ++s) {
    auto& column = block.values[cells + s];
    column.insert(column.end(), results.series[s].begin(), results.series[s].end());
  }
  block.rows += results.count;
}

void StatusCounts::add(const SweepTask& task, const CaseResults& results) {
  unmet.resize(task.expectations.size());
  for (std::size_t i = 0; i < results.count; ++i) {
    const CaseStatus& status = results.status[i];
    const bool done = status.word == "done";
    ++words[status.word];
    not_finite += done && !status.reason.empty() ? 1 : 0;
    bool as_expected = true;
    for (std::size_t e = 0; e < unmet.size(); ++e) {
      if (holds(task, results, i, e)) continue;
      ++unmet[e];
      as_expected = false;
    }
    if ((done && as_expected) || failed.size() >= most_failed) continue;
    failed.push_back({results.first + i, status.word, done ? "not as expected" : status.reason});
  }
}

std::size_t StatusCounts::early() const {
  std::size_t early = 0;
  for (const auto& [word, count] : words) early += word == "done" ? 0 : count;
  return early;
}

}  // namespace bbsim::sweep
