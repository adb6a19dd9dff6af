// What is left to say of a case once its run has ended.
#pragma once

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Measures that the case's scene does not have become no numbers; and a case that is done has a
// reason for each measure that is no finite number.
void judge(const SweepTask& task, const Scenario& scenario, double* measures, CaseStatus& status);

}  // namespace bbsim::sweep
