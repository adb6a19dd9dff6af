#include "plot/result.hpp"

#include <algorithm>

namespace bbsim::plot {

const Column* Result::find(std::string_view name) const {
  const auto found = std::ranges::find(columns, name, &Column::name);
  return found == columns.end() ? nullptr : &*found;
}

bool Result::is_sweep() const {
  return !columns.empty() && columns.front().name == "case" && find("status") != nullptr;
}

}  // namespace bbsim::plot
