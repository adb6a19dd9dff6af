// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/case_file.hpp"

#include <limits>
#include <utility>

#include "base/error.hpp"
#include "file/atomic_file.hpp"
#include "file/format.hpp"
#include "sweep/case_file_hdf5.hpp"
#include "sweep/case_part.hpp"

namespace bbsim::sweep {
namespace {

// Standard output, a pipe or a device. Writes rows immediately, so all of them stay if the run ends
// early.
class Stream : public CaseFile {
 public:
  Stream(const std::string& target, const CaseFileLayout& layout) : file_(target) {
    file_.write(header_of(layout.columns) + '\n');
  }

  [[nodiscard]] const KeptRows& kept() const override { return kept_; }
  [[nodiscard]] std::string part() const override { return ""; }
  void append(std::string_view lines, std::size_t /*rows*/,
              const std::vector<std::vector<double>>& /*CSV has no series*/) override {
    file_.write(lines);
    file_.flush();
  }
  void interrupt() override { file_.commit(); }
  void finish(const file::Attributes&) override { file_.commit(); }

 private:
  file::AtomicFile file_;
  KeptRows kept_;
};

class Csv : public CaseFile {
 public:
  Csv(const std::string& target, CaseFileLayout layout, const std::string& plan, bool resume)
      : layout_(std::move(layout)), part_(target, layout_, plan, resume) {
    part_.resume(std::numeric_limits<std::size_t>::max());
  }

  [[nodiscard]] const KeptRows& kept() const override { return part_.kept(); }
  [[nodiscard]] std::string part() const override {
    return part_.file().in_place() ? part_.file().name() : "";
  }
  void append(std::string_view lines, std::size_t rows,
              const std::vector<std::vector<double>>& /*CSV has no series*/) override {
    part_.append(lines, rows);
  }
  void interrupt() override { part_.file().sync(); }
  void finish(const file::Attributes& /*CSV has no place for them*/) override {
    part_.check_complete();
    part_.file().commit(layout_.is_shard);
  }

 private:
  CaseFileLayout layout_;
  CasePart part_;
};

}  // namespace

void check_case_target(const std::string& target, const CaseFileLayout& layout, bool resume) {
  const bool direct = file::is_written_directly(target);
  const file::Format format = file::format_of(target);
  if (!direct && format == file::Format::other) {
    throw InputError("cannot tell the format of " + target +
                     " from its name; allowed endings: .csv, .h5, .hdf5");
  }
  if (!layout.axis_values.empty() && (direct || format != file::Format::hdf5)) {
    throw InputError("cannot keep trajectories in " + target +
                     ": trajectories need a file that ends in .h5 or .hdf5");
  }
  if (direct && resume) {
    throw InputError("cannot resume on " + target +
                     ": only a regular file keeps the cases that were done");
  }
}

std::unique_ptr<CaseFile> open_case_file(const std::string& target, CaseFileLayout layout,
                                         const std::string& plan, bool resume) {
  check_case_target(target, layout, resume);
  if (file::is_written_directly(target)) return std::make_unique<Stream>(target, layout);
  if (file::format_of(target) == file::Format::hdf5) {
    return open_case_file_hdf5(target, std::move(layout), plan, resume);
  }
  return std::make_unique<Csv>(target, std::move(layout), plan, resume);
}

std::vector<std::string> case_files_beside(const std::string& target) {
  if (file::is_written_directly(target)) return {};
  return sweep::PartFile::names_beside(target);
}

}  // namespace bbsim::sweep
