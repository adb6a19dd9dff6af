// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/case_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "base/error.hpp"
#include "file/own_file.hpp"

namespace bbsim::sweep {
namespace {

// Reads the cases of a journal in place of computing them.
class RecordRunner : public CaseRunner {
 public:
  explicit RecordRunner(const Journal& journal) : journal_(journal) {}

  std::size_t run(std::size_t first, std::size_t count, CaseResults& into,
                  const std::atomic<bool>& /*one record is short*/) override {
    journal_.read(first, into);
    return count;
  }

 private:
  const Journal& journal_;
};

std::string plan_beside(const std::string& target) {
  return file::follow_links(target).value_or(target) + ".plan";
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

void check_case_target(const std::string& target, const CaseFileLayout& layout, bool resume) {
  file::require_table_name(target);
  const bool direct = file::is_written_directly(target);
  if (!layout.axis_values.empty() && (direct || file::format_of(target) != file::Format::hdf5)) {
    throw InputError("cannot keep trajectories in " + target +
                     ": trajectories need a file that ends in .h5 or .hdf5");
  }
  if (direct && resume) {
    throw InputError("cannot resume on " + target +
                     ": only a regular file keeps the cases that were done");
  }
}

std::vector<std::string> case_files_beside(const std::string& target) {
  if (file::is_written_directly(target)) return {};
  return {Journal::name_of(target), plan_beside(target)};
}

CaseFile::CaseFile(const std::string& target, CaseFileLayout layout, const SweepTask& task,
                   const std::string& plan, bool resume)
    : target_(target), layout_(std::move(layout)), task_(task), plan_(plan) {
  check_case_target(target_, layout_, resume);
  if (file::is_written_directly(target_)) {
    direct_ = std::make_unique<file::AtomicFile>(target_);
    direct_->write(header_of(layout_.columns) + '\n');
    return;
  }
  // What would fail at the end should fail before any case is run.
  if (file::format_of(target_) == file::Format::hdf5) {
    file::require_hdf5(target_);
  } else {
    static_cast<void>(file::find_own_file(plan_beside(target_)));
  }
  journal_ = std::make_unique<Journal>(target_, task_, layout_.range, plan_, resume);
}

const KeptCases& CaseFile::kept() const {
  static const KeptCases none;
  return journal_ ? journal_->kept() : none;
}

std::string CaseFile::part() const {
  return journal_ && journal_->in_place() ? journal_->name() : "";
}

void CaseFile::prepare(CaseResults& results) const {
  if (journal_) return journal_->encode(results);
  write_rows(task_, results);
}

// Standard output gets the rows immediately, so all of them stay if the run ends early.
void CaseFile::append(const CaseResults& results) {
  if (journal_) return journal_->append(results);
  direct_->write(results.text);
  direct_->flush();
}

void CaseFile::interrupt() {
  journal_ ? journal_->sync() : direct_->commit();
}

bool CaseFile::finish(const file::Attributes& attributes, const Collecting& how) {
  if (direct_) {
    direct_->commit();
    return true;
  }
  journal_->check_complete();
  const bool is_hdf5 = file::format_of(target_) == file::Format::hdf5;
  if (!(is_hdf5 ? write_hdf5(attributes, how) : write_csv(how))) return false;
  journal_->discard();
  return true;
}

bool CaseFile::collect(const Collecting& how, const std::function<void(CaseResults&)>& prepare,
                       const std::function<void(const CaseResults&)>& deliver) const {
  const std::vector<std::size_t>& ends = journal_->ends();
  const Engine records{"", task_, 1, [this] { return std::make_unique<RecordRunner>(*journal_); },
                       &ends};
  std::size_t cases = 0;
  return run_sweep(records, layout_.range, std::min(how.threads, ends.size()), how.stop, prepare,
                   [&](const CaseResults& results) {
                     deliver(results);
                     how.tell(cases += results.count);
                   });
}

bool CaseFile::write_csv(const Collecting& how) {
  file::AtomicFile csv(target_, file::Durable::yes);
  csv.write(header_of(layout_.columns) + '\n');
  const bool whole = collect(
      how, [this](CaseResults& results) { write_rows(task_, results); },
      [&csv](const CaseResults& results) { csv.write(results.text); });
  if (!whole) return false;
  settle_plan();
  csv.commit();
  return true;
}

bool CaseFile::write_hdf5(const file::Attributes& attributes, const Collecting& how) {
  std::vector<file::Hdf5Axis> axes;
  if (!layout_.axis_values.empty()) axes.emplace_back(layout_.axis, layout_.axis_values);
  file::Hdf5TableWriter writer(target_, layout_.columns, axes);
  writer.keep(layout_.inputs);
  file::Hdf5Block block;
  const bool whole = collect(
      how, [](CaseResults&) {},
      [&](const CaseResults& results) {
        append_rows(task_, results, block);
        writer.append(block);
        for (std::vector<double>& column : block.values) column.clear();
        for (std::vector<std::string>& column : block.texts) column.clear();
        block.rows = 0;
      });
  if (whole) writer.finish(attributes);
  return whole;
}

// A CSV shard gets its plan before its name. No other CSV keeps one, not even an earlier shard's.
void CaseFile::settle_plan() const {
  const std::string name = plan_beside(target_);
  if (!layout_.is_shard) {
    return file::remove_own_file(name, file::find_own_file(name).get());
  }
  const file::Descriptor plan = file::open_own_file(name);
  int error = ftruncate(plan.get(), 0) == 0 ? 0 : errno;
  const file::Target target = file::find_target(target_);
  if (error == 0 && target.found) error = file::take_after(plan.get(), *target.found);
  if (error == 0) error = file::write_all(plan.get(), plan_);
  if (error == 0) error = file::sync_content(plan.get());
  if (error != 0) file::fail_to_write(name, error);
}

}  // namespace bbsim::sweep
