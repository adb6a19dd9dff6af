// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/case_part.hpp"

#include <algorithm>
#include <utility>

#include "base/error.hpp"

namespace bbsim::sweep {
namespace {

std::size_t status_field(const std::vector<file::Hdf5Column>& columns) {
  const auto found =
      std::find_if(columns.begin(), columns.end(),
                   [](const file::Hdf5Column& column) { return column.name == "status"; });
  return static_cast<std::size_t>(found - columns.begin());
}

}  // namespace

std::string header_of(const std::vector<file::Hdf5Column>& columns) {
  std::string line;
  for (const file::Hdf5Column& column : columns) {
    if (column.kind == file::Hdf5Kind::series) continue;
    if (!line.empty()) line += ',';
    line += column.name;
  }
  return line;
}

CasePart::CasePart(const std::string& target, const CaseFileLayout& layout, const std::string& plan,
                   bool resume)
    : layout_(layout), header_(header_of(layout.columns)), file_(target, plan, resume) {}

std::string CasePart::fault_of_header(std::string_view line, bool whole) const {
  return whole && line == header_ ? "" : "its header is not as it was written";
}

std::string CasePart::fault_of(std::string_view line, bool whole, std::size_t row,
                               RowReader& reader) const {
  const std::size_t number = layout_.first_case + row;
  std::string found = row >= layout_.cases ? "a row more than there are cases" : reader.read(line);
  if (found.empty() && reader.case_number() != number) {
    found = "case " + std::to_string(reader.case_number());
  }
  if (found.empty() && !whole) found = "no line end";
  if (found.empty()) return "";
  return "the row of case " + std::to_string(number) + " is not as it was written (found " + found +
         ")";
}

void CasePart::resume(std::size_t most) {
  const std::size_t status = status_field(layout_.columns);
  const auto series =
      std::ranges::count(layout_.columns, file::Hdf5Kind::series, &file::Hdf5Column::kind);
  const std::size_t expected =
      layout_.columns.size() - static_cast<std::size_t>(series) - layout_.expectations;
  PartLines lines(file_.descriptor(), file_.name(), Blame::output);
  RowReader reader(layout_.columns);
  std::string_view line;
  std::string fault;
  off_t end = 0;  // end of the header and the whole groups
  StatusCounts of_group;
  std::size_t in_group = 0;
  // A last line without a line break is no fault: the earlier run was cut off there.
  if (lines.next(line) && (fault = fault_of_header(line, lines.whole())).empty()) end = lines.end();
  if (!fault.empty() && !lines.whole() && header_.starts_with(line)) fault.clear();
  while (end > 0 && kept_.rows + in_group < most && lines.next(line)) {
    fault = fault_of(line, lines.whole(), kept_.rows + in_group, reader);
    if (!fault.empty() && !lines.whole() && line.find('\0') == std::string_view::npos)
      fault.clear();
    if (!fault.empty() || !lines.whole()) break;
    const std::size_t number = reader.case_number();
    if (status < layout_.columns.size()) {
      of_group.add(number, reader.text(status), reader.text(status + 1));
    }
    for (std::size_t i = 0; i < layout_.expectations; ++i) {
      of_group.add_expected(number, i, reader.number(expected + i) != 0);
    }
    if (++in_group < layout_.group && kept_.rows + in_group < layout_.cases) continue;
    kept_.statuses.add(of_group);
    kept_.rows += std::exchange(in_group, 0);
    of_group = {};
    end = lines.end();
  }
  if (end > 0 && fault.empty() && kept_.rows + in_group == most && lines.next(line)) {
    fault = "the trajectories of case " + std::to_string(layout_.first_case + most) +
            " are not as they were written";
  }
  if (!fault.empty()) {
    kept_.trouble = file_.name() + ": " + fault + "; continuing from case " +
                    std::to_string(layout_.first_case + kept_.rows);
  }
  file_.keep_only(end);
  if (end == 0) file_.append(header_ + '\n');
  rows_ = kept_.rows;
  file_.set_worth_keeping(rows_ > 0);
}

void CasePart::append(std::string_view lines, std::size_t rows) {
  file_.set_worth_keeping(true);
  file_.append(lines);
  rows_ += rows;
}

void CasePart::check_complete(std::size_t rows) const {
  if (rows == layout_.cases && rows_ == layout_.cases) return;
  refuse("it has " + std::to_string(std::min(rows, rows_)) + " rows of " +
         std::to_string(layout_.cases));
}

void CasePart::refuse(const std::string& fault) const {
  throw OutputError(
      "cannot complete " + file_.name() + ": " + fault +
      "; run the sweep again with --resume, which continues after the last sound case");
}

}  // namespace bbsim::sweep
