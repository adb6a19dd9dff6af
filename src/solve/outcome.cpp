#include "solve/outcome.hpp"

#include <utility>

namespace bbsim::solve {

Outcome with_all_rows(Outcome outcome, std::size_t rows) {
  if (outcome.ending != Ending::done || outcome.rows == rows) return outcome;
  outcome.ending = Ending::failed;
  outcome.reason = "rows were lost by a fault of this program: it came to the end with " +
                   std::to_string(outcome.rows) + " of " + std::to_string(rows);
  return outcome;
}

}  // namespace bbsim::solve
