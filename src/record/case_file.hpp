// The results of a sweep on their way into a file: CSV or HDF5, whole under its final name once all
// cases are there, and until then a part that can be gone on with.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "record/case_table.hpp"
#include "record/table_writer.hpp"

namespace bbsim::record {

struct CaseFileLayout {
  std::vector<CaseColumn> columns;  // numbers and texts, then series
  CaseColumn axis{};                // of the series, if there are any
  std::vector<double> axis_values{};
};

// What a row of all columns but the series is: fields parted by commas (record/case_text.hpp) and
// "\n". Functions throw OutputError.
class CaseFile {
 public:
  virtual ~CaseFile() = default;

  // Rows that an earlier, unfinished run left: those of the first cases.
  [[nodiscard]] virtual std::size_t kept() const = 0;
  // Keeps only so many of them.
  virtual void keep_only(std::size_t rows) = 0;
  // The part's name, empty if nothing stays of an unfinished run.
  [[nodiscard]] virtual std::string part() const = 0;

  // Some rows; of each series, rows * width numbers.
  virtual void append(std::string_view lines, const std::vector<std::vector<double>>& series) = 0;
  virtual void finish(const Attributes& attributes) = 0;
};

// `plan` says all that the results depend on, so that with `resume` no other sweep's part is taken
// up. "-" is standard output; that, and what is no regular file, gets CSV as it comes. Throws
// InputError for another ending than .csv, .h5 and .hdf5, for series anywhere but in HDF5, and for
// a part that cannot be gone on with.
[[nodiscard]] std::unique_ptr<CaseFile> open_case_file(const std::string& target,
                                                       CaseFileLayout layout,
                                                       const std::string& plan, bool resume);

}  // namespace bbsim::record
