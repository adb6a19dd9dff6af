// Measures of a stored run: its rows, with straight lines between.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "file/table_writer.hpp"
#include "scenario/measures.hpp"

namespace bbsim::record {

// A table of a run, whose columns need not be bbsim's own.
class StoredRun {
 public:
  // Throws InputError where the table, of that name, has no t, no rows, or times that fall.
  StoredRun(file::TableData table, const std::string& name);
  StoredRun(const StoredRun&) = delete;  // columns look at this one's names
  StoredRun& operator=(const StoredRun&) = delete;

  // The measures of these names. Throws InputError.
  [[nodiscard]] std::vector<scenario::Measure> measures_named(
      const std::vector<std::string>& names) const;

  // min_ and max_ are those of the rows; all else, but rms_ and end_, is taken as if the columns
  // went straight from row to row. Rows with a value that is no finite number are passed over.
  [[nodiscard]] double value_of(const scenario::Measure& measure) const;

 private:
  [[nodiscard]] const scenario::Column* find(std::string_view name) const;
  [[nodiscard]] const std::vector<double>& values_of(const scenario::Column& column) const;

  std::string name_;
  file::TableData table_;
  std::vector<scenario::Column> columns_;
  const std::vector<double>* times_ = nullptr;
};

}  // namespace bbsim::record
