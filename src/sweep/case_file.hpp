// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes a sweep's results to a CSV or HDF5 file. The file appears whole under its final name once
// all cases are done. Until then a journal holds them, and a later run can continue it.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "file/atomic_file.hpp"
#include "file/hdf5_table.hpp"
#include "file/table_writer.hpp"
#include "sweep/journal.hpp"

namespace bbsim::sweep {

struct CaseFileLayout {
  std::vector<file::Hdf5Column> columns;  // case first, then numbers and texts, then series
  file::Hdf5Column axis{};                // describes axis_values
  std::vector<double> axis_values{};
  std::vector<file::InputTable> inputs{};  // tables that the scenario read, kept in HDF5 only
  CaseRange range{};
  bool is_shard = false;  // a part to be merged later; CSV keeps the plan beside it
};

// The header of the CSV text: the names of all columns but the series.
[[nodiscard]] std::string header_of(const std::vector<file::Hdf5Column>& columns);

// Throws InputError for an ending other than .csv, .h5 and .hdf5, for series outside HDF5, and for
// `resume` on a target that keeps no journal. "-" is standard output.
void check_case_target(const std::string& target, const CaseFileLayout& layout, bool resume);

// The files written beside the target until it is complete, and the plan of a CSV shard; none if
// rows go directly to the target.
[[nodiscard]] std::vector<std::string> case_files_beside(const std::string& target);

// Functions throw OutputError.
class CaseFile {
 public:
  // `plan` holds everything that the results depend on; `resume` accepts only a journal with the
  // same plan. Standard output and targets that are not regular files get CSV rows as they come.
  // Throws InputError as check_case_target() does, and for a journal that cannot be continued.
  CaseFile(const std::string& target, CaseFileLayout layout, const SweepTask& task,
           const std::string& plan, bool resume);

  [[nodiscard]] const KeptCases& kept() const;
  // The name of the journal; empty if an unfinished run leaves none.
  [[nodiscard]] std::string part() const;

  // Writes what append() needs into the results' text. Any thread may call it.
  void prepare(CaseResults& results) const;
  void append(const CaseResults& results);
  // Keeps the cases so far. Call it if the run ends before all cases are done.
  void interrupt();
  // Collects the cases in the target, on several threads. Tells the number of cases so far. Returns
  // false if `stop` ended it; the journal then has all cases.
  struct Collecting {
    std::size_t threads;
    const std::atomic<bool>& stop;
    std::function<void(std::size_t)> tell;
  };
  [[nodiscard]] bool finish(const file::Attributes& attributes, const Collecting& how);

 private:
  [[nodiscard]] bool collect(const Collecting& how,
                             const std::function<void(CaseResults&)>& prepare,
                             const std::function<void(const CaseResults&)>& deliver) const;
  [[nodiscard]] bool write_csv(const Collecting& how);
  [[nodiscard]] bool write_hdf5(const file::Attributes& attributes, const Collecting& how);
  void settle_plan() const;

  std::string target_;
  CaseFileLayout layout_;
  const SweepTask& task_;
  std::string plan_;
  // One of both.
  std::unique_ptr<file::AtomicFile> direct_;
  std::unique_ptr<Journal> journal_;
};

}  // namespace bbsim::sweep
