// stub until the HDF5 part is merged
#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "record/table_writer.hpp"
namespace bbsim::record {
enum class CaseKind { number, text, series };
struct CaseColumn {
  std::string name, unit, meaning;
  CaseKind kind = CaseKind::number;
  std::size_t width = 1;
};
}  // namespace bbsim::record
