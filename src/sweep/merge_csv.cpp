// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The CSV side of merge.hpp.
#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "file/atomic_file.hpp"
#include "sweep/case_rows.hpp"
#include "sweep/merge_parts.hpp"
#include "sweep/plan_text.hpp"

namespace bbsim::sweep {
namespace {

constexpr off_t largest_plan = off_t{64} * 1024 * 1024;  // bytes

struct CsvPart {
  std::string file, header;
  std::size_t first = 0;  // first case; 0 if the part has no rows, so that it comes first
  dev_t device = 0;
  ino_t inode = 0;
};

[[noreturn]] void cannot_read(const std::string& file, const std::string& reason) {
  throw InputError("cannot read " + file + ": " + reason);
}

// Parts are opened one at a time, so any number of them can be merged.
file::Descriptor open_part(const std::string& file, struct stat& status) {
  file::Descriptor opened = file::above_standard_streams(
      open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!opened.is_open() || fstat(opened.get(), &status) != 0)
    cannot_read(file, file::error_text(errno));
  if (!S_ISREG(status.st_mode))
    cannot_read(file, "it is not a regular file, and bbsim reads parts twice");
  return opened;
}

[[noreturn]] void refuse_row(const std::string& file, const std::string& found, std::size_t row) {
  throw InputError(file + ": found " + found + " in row " + std::to_string(row) +
                   " below the header; allowed: a file that bbsim sweep wrote");
}

CsvPart inspect(const std::string& file) {
  struct stat status {};
  const file::Descriptor opened = open_part(file, status);
  PartLines lines(opened.get(), file, Blame::input);
  std::string_view line;
  if (!lines.next(line) || !lines.whole()) cannot_read(file, "it is not a file with rows of cases");
  if (!line.starts_with("case,")) {
    throw InputError(file + ": found the first column " +
                     std::string(line.substr(0, line.find(','))) +
                     "; allowed: case, as bbsim sweep writes it");
  }
  CsvPart part{file, std::string(line), 0, status.st_dev, status.st_ino};
  if (lines.next(line)) {
    RowReader reader(part.header);
    if (const std::string found = reader.read(line); !found.empty()) refuse_row(file, found, 1);
    part.first = reader.case_number();
  }
  return part;
}

// Reads the plan of a part, if it has one. While a sweep to the same name is unfinished, the plan
// there belongs to that sweep.
std::optional<std::string> read_plan(const std::string& part) {
  const std::string file = plan_of_part(part);
  if (file.empty()) return {};
  struct stat status {};
  const file::Descriptor opened = open_part(file, status);
  if (status.st_size > largest_plan) cannot_read(file, "it is larger than any plan");
  std::string text(static_cast<std::size_t>(status.st_size), '\0');
  const ssize_t size = file::read_at(opened.get(), text.data(), text.size(), 0);
  if (size < 0) cannot_read(file, file::error_text(errno));
  text.resize(static_cast<std::size_t>(size));
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
    common.instruction_sets.add(instruction_set_in(*plan));
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
  struct stat status {};
  const file::Descriptor opened = open_part(part.file, status);
  if (status.st_dev != part.device || status.st_ino != part.inode) {
    cannot_read(part.file, "another file took its place meanwhile");
  }
  PartLines lines(opened.get(), part.file, Blame::input);
  RowReader reader(part.header);
  std::string_view line;
  if (!lines.next(line) || line != part.header) {
    cannot_read(part.file, "its header has changed meanwhile");
  }
  for (std::size_t row = 1; lines.next(line); ++row) {
    if (stop.load(std::memory_order_relaxed)) return false;
    if (!lines.whole()) {
      throw InputError(part.file +
                       ": found an incomplete last row; allowed: a part whose sweep has ended");
    }
    if (const std::string found = reader.read(line); !found.empty())
      refuse_row(part.file, found, row);
    check_case(part.file, reader.case_number(), next);
    ++next;
    // The line break follows the line in the buffer.
    out.write({line.data(), line.size() + 1});
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
  Merged merged{0, false, common.instruction_sets.note()};
  for (const CsvPart& part : parts) {
    if (copy_rows(part, out, merged.cases, stop)) continue;
    merged.interrupted = true;
    return merged;
  }
  if (common.cases) check_all_there(merged.cases, *common.cases);
  out.commit();
  return merged;
}

}  // namespace bbsim::sweep
