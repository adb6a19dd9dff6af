// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The CSV side of merge.hpp.
#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "file/atomic_file.hpp"
#include "file/csv_fields.hpp"
#include "file/descriptor.hpp"
#include "file/line_reader.hpp"
#include "sweep/merge_parts.hpp"
#include "sweep/plan_text.hpp"

namespace bbsim::sweep {
namespace {

constexpr std::size_t largest_plan = std::size_t{64} * 1024 * 1024;  // bytes

[[noreturn]] void cannot_read(const std::string& file, const std::string& reason) {
  throw InputError("cannot read " + file + ": " + reason);
}

void require_regular(const std::string& file) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored)) {
    cannot_read(file, "it is not a regular file, and bbsim reads parts twice");
  }
}

// Reads the rows of a part and checks each of them. Parts are opened one at a time, so any number
// of them can be merged.
class Rows {
 public:
  explicit Rows(const std::string& file) : file_(file), lines_((require_regular(file), file)) {
    header_ = std::string(lines_.next().value_or(std::string_view()));
    if (!lines_.whole()) cannot_read(file, "it is not a file with rows of cases");
    static_cast<void>(file::split_fields(header_, names_));
    if (names_.size() < 2 || names_[0] != "case") {
      throw InputError(file + ": found the first column " + names_[0] +
                       "; allowed: case, as bbsim sweep writes it");
    }
    // The header does not tell which fields before the status are numbers; numbers follow it and
    // the reason.
    const auto status = std::ranges::find(names_, "status");
    first_number_ = static_cast<std::size_t>(status - names_.begin()) + 1;
    if (first_number_ < names_.size() && names_[first_number_] == "reason") ++first_number_;
  }

  [[nodiscard]] const std::string& header() const { return header_; }
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::size_t case_number() const { return case_number_; }

  // Goes to the next row. Returns false at the end. Throws InputError for a row that no sweep
  // writes.
  bool next() {
    const auto line = lines_.next();
    if (!line) return false;
    line_ = *line;
    if (!lines_.whole()) {
      throw InputError(file_ +
                       ": found an incomplete last row; allowed: a part whose sweep has ended");
    }
    if (const std::string found = fault(); !found.empty()) {
      throw InputError(file_ + ": found " + found + " in row " +
                       std::to_string(lines_.number() - 1) +
                       " below the header; allowed: a file that bbsim sweep wrote");
    }
    return true;
  }

 private:
  std::string fault() {
    if (line_.find('\0') != std::string_view::npos)
      return "zero bytes";  // a disk page that was never written
    const bool closed = file::split_fields(line_, fields_);
    written_.clear();
    for (const std::string& field : fields_) file::append_text(written_, field), written_ += ',';
    written_.pop_back();
    if (!closed || written_ != line_) return "quotes that no sweep writes";
    const auto number = number_in<std::size_t>(fields_[0]);
    if (!number) return "a row that does not begin with the number of a case";
    case_number_ = *number;
    if (fields_.size() != names_.size()) {
      return std::to_string(fields_.size()) + (fields_.size() == 1 ? " field" : " fields") +
             " where " + std::to_string(names_.size()) + " belong";
    }
    for (std::size_t i = first_number_; i < fields_.size(); ++i) {
      if (!number_in<double>(fields_[i])) {
        return "something other than a number in field " + std::to_string(i + 1);
      }
    }
    return "";
  }

  std::string file_, header_;
  file::LineReader lines_;
  std::vector<std::string> names_, fields_;
  std::string written_;
  std::size_t first_number_ = 0, case_number_ = 0;
  std::string_view line_;
};

struct CsvPart {
  std::string file, header;
  std::size_t first = 0;  // first case; 0 if the part has no rows, so that it comes first
};

CsvPart inspect(const std::string& file) {
  Rows rows(file);
  return {file, rows.header(), rows.next() ? rows.case_number() : 0};
}

// Reads the plan of a part, if it has one. While a sweep to the same name is unfinished, the plan
// there belongs to that sweep.
std::optional<std::string> read_plan(const std::string& part) {
  const std::string file = plan_of_part(part);
  if (file.empty()) return {};
  require_regular(file);
  std::string text = file::read_whole(file, {}, largest_plan);
  if (!is_plan(text)) {
    throw InputError(file + ": found no plan of bbsim sweep; remove it to merge " + part +
                     " without one");
  }
  return text;
}

struct CommonPlan {
  std::optional<std::size_t> cases;  // of the whole sweep
  InstructionSets instruction_sets;
};

// Skips parts that have no plan.
CommonPlan compare_plans_of(const std::vector<std::string>& files) {
  CommonPlan common;
  std::string first_file, first_plan;
  for (const std::string& file : files) {
    const std::optional<std::string> plan = read_plan(file);
    if (!plan) continue;
    common.instruction_sets.insert(instruction_set_in(*plan));
    if (first_file.empty()) {
      first_file = file;
      first_plan = *plan;
      common.cases = cases_in(*plan);
      continue;
    }
    const PlanDifference difference = compare_plans(first_plan, *plan, true);
    if (difference.keys.empty()) continue;
    throw InputError(file + ": is a part of another sweep than " + first_file +
                     ": their plans differ in " + difference.keys +
                     "; allowed: parts of one sweep");
  }
  return common;
}

// Writes the rows of a part. Checks that their cases continue from `next`, and advances it. Returns
// false if interrupted.
bool copy_rows(const CsvPart& part, file::AtomicFile& out, std::size_t& next,
               const std::atomic<bool>& stop) {
  Rows rows(part.file);
  if (rows.header() != part.header) cannot_read(part.file, "its header has changed meanwhile");
  while (rows.next()) {
    if (stop.load(std::memory_order_relaxed)) return false;
    check_case(part.file, rows.case_number(), next++);
    out.write(rows.line());
    out.write("\n");
  }
  return true;
}

}  // namespace

Merged merge_csv(const std::vector<std::string>& files, const std::string& target,
                 const std::atomic<bool>& stop) {
  const CommonPlan common = compare_plans_of(files);
  std::vector<CsvPart> parts;
  for (const std::string& file : files) parts.push_back(inspect(file));
  for (const CsvPart& part : parts) {
    if (part.header == parts.front().header) continue;
    throw InputError(part.file + ": found other columns than in " + parts.front().file +
                     "; allowed: parts of one sweep");
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const CsvPart& a, const CsvPart& b) { return a.first < b.first; });

  file::AtomicFile out(target, file::Durable::yes);
  out.write(parts.front().header + '\n');
  Merged merged{0, false, note_on(common.instruction_sets)};
  for (const CsvPart& part : parts) {
    if (copy_rows(part, out, merged.cases, stop)) continue;
    merged.interrupted = true;
    return merged;
  }
  if (common.cases) check_all_there(merged.cases, std::to_string(*common.cases));
  out.commit();
  return merged;
}

}  // namespace bbsim::sweep
