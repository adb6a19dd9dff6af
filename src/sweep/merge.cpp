// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/merge.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "file/atomic_file.hpp"
#include "file/csv_fields.hpp"
#include "file/descriptor.hpp"
#include "file/line_reader.hpp"
#include "file/table_writer.hpp"
#include "file/target.hpp"
#include "sweep/plan_text.hpp"

namespace bbsim::sweep {
namespace {

bool is_hdf5(const std::string& file) {
  return file::format_of(file) == file::Format::hdf5;
}

struct ShardName {
  std::size_t number, of;
};

// Reads the numbers in "...-2of3.csv".
std::optional<ShardName> shard_in(const std::string& file) {
  const std::string stem = std::filesystem::path(file).stem();
  const std::size_t dash = stem.rfind('-'), of = stem.rfind("of");
  if (dash == std::string::npos || of == std::string::npos || of < dash) return {};
  const std::string_view text = stem;
  const auto number = number_in<std::size_t>(text.substr(dash + 1, of - dash - 1)),
             count = number_in<std::size_t>(text.substr(of + 2));
  return number && count ? std::optional(ShardName{*number, *count}) : std::nullopt;
}

void check_names(const std::vector<std::string>& parts) {
  std::size_t of = 0;
  std::set<std::size_t> seen;
  for (const std::string& part : parts) {
    if (const auto name = shard_in(part)) {
      of = std::max(of, name->of);
      seen.insert(name->number);
    }
  }
  for (std::size_t k = 1; k <= of && !seen.empty(); ++k) {
    if (seen.count(k) == 0) {
      throw InputError("found parts of " + std::to_string(of) + ", but not part " +
                       std::to_string(k) + "; allowed: all parts of the sweep");
    }
  }
}

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

struct PartPlan {
  std::string text;
  PlanFacts facts;
};

// Reads the plan of a part, if it has one. While a sweep to the same name is unfinished, the plan
// there belongs to that sweep.
std::optional<PartPlan> read_plan(const std::string& part) {
  const std::string file = plan_of_part(part);
  if (file.empty()) return {};
  require_regular(file);
  std::string text = file::read_whole(file, {}, largest_plan);
  const std::optional<PlanFacts> facts = facts_in(text);
  if (!facts) {
    throw InputError(file + ": found no plan of bbsim sweep; remove it to merge " + part +
                     " without one");
  }
  return PartPlan{std::move(text), *facts};
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
    const std::optional<PartPlan> plan = read_plan(file);
    if (!plan) continue;
    common.instruction_sets.insert(plan->facts.instruction_set);
    if (first_file.empty()) {
      first_file = file;
      first_plan = plan->text;
      common.cases = plan->facts.cases;
      continue;
    }
    const PlanDifference difference = compare_plans(first_plan, plan->text, true);
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

}  // namespace

Merged merge_cases(const std::vector<std::string>& parts, const std::string& target,
                   const std::atomic<bool>& stop) {
  check_names(parts);
  const bool to_hdf5 = !file::is_written_directly(target) && is_hdf5(target);
  file::require_table_name(target);
  const auto hdf5 = static_cast<std::size_t>(std::count_if(parts.begin(), parts.end(), is_hdf5));
  if ((hdf5 > 0) != to_hdf5 || (hdf5 > 0 && hdf5 < parts.size())) {
    throw InputError("found CSV and HDF5 together; allowed: parts and a file of one format");
  }
  return to_hdf5 ? merge_hdf5(parts, target, stop) : merge_csv(parts, target, stop);
}

std::string plan_of_part(const std::string& part) {
  const std::string path = file::follow_links(part).value_or(part);
  std::error_code ignored;
  const auto exists = [&](const std::string& file) {
    return std::filesystem::exists(std::filesystem::symlink_status(file, ignored));
  };
  return exists(path + ".plan") && !exists(path + ".part") ? path + ".plan" : "";
}

void check_case(const std::string& file, std::size_t found, std::size_t expected) {
  if (found == expected) return;
  throw InputError(file + ": found case " + std::to_string(found) + " where case " +
                   std::to_string(expected) +
                   " should come; allowed: every case of the sweep once");
}

void check_all_there(std::size_t found, const std::string& expected) {
  if (std::to_string(found) == expected) return;
  throw InputError("found " + std::to_string(found) + " cases of " + expected +
                   "; allowed: all parts of the sweep");
}

std::string names_of(const InstructionSets& sets) {
  std::string list;
  for (const std::string& name : sets) list += (list.empty() ? "" : " and ") + name;
  return list;
}

std::string note_on(const InstructionSets& sets) {
  if (sets.size() < 2) return "";
  return "the parts are of " + names_of(sets) + ": alike within the tolerance, not bit for bit";
}

}  // namespace bbsim::sweep
