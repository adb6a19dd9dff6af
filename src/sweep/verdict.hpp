// What is left to say of a case once its run has ended.
#pragma once

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Measures that the case's scene does not have become no numbers; and a case that is done has a
// reason for each measure that is no finite number.
void judge(const SweepTask& task, const Scenario& scenario, double* measures, CaseStatus& status);

// The same of cases that are done, of most of which there is nothing to say. `first` is the sweep's
// first case: in the others the same measures have a meaning.
class DoneVerdict {
 public:
  DoneVerdict(const SweepTask& task, const Scenario& first);

  // What `status` was before does not matter.
  void judge(const Scenario& scenario, double* measures, CaseStatus& status) const;

 private:
  const SweepTask& task_;
  bool has_all_;  // columns that the measures are of
};

}  // namespace bbsim::sweep
