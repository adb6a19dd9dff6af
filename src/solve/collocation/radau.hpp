// bbsim's own integrator: Radau IIA collocation of high order, its stages in SIMD lanes.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "model/model.hpp"
#include "solve/collocation/kernel.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/row_block.hpp"

namespace bbsim::solve {

// L-stable and superconvergent: stiff servos cost no more steps than the motion itself does. The
// collocation polynomial gives the rows between steps. gamma is the polynomial's integral, under
// error control. The model's stops are reached exactly and restarted from.
//
// Throws InputError if the environment variable BBSIM_SIMD names no instruction set of this
// processor.
[[nodiscard]] Outcome integrate_radau(const model::Model& model, Tolerances tolerances,
                                      const OutputGrid& grid, StateSink& sink, const Watch& watch);

// The same with another number of stages than integrate_radau would take: a run to check that one
// against, with different steps and different rounding.
[[nodiscard]] Outcome integrate_radau_unlike(const model::Model& model, Tolerances tolerances,
                                             const OutputGrid& grid, StateSink& sink,
                                             const Watch& watch);

namespace collocation {

// The kernels for the best instruction set of this processor, or the one that BBSIM_SIMD names:
// avx512, avx2 or sse2. Throws InputError for another name, or one this processor lacks.
[[nodiscard]] const KernelSet& choose_kernels();

// By name; null if this processor or this build has none.
[[nodiscard]] const KernelSet* find_kernels(const char* name);

// How many stages suit a relative tolerance: 8, 12 or 16.
[[nodiscard]] int choose_stages(double rtol);

// Integrates one model again and again without allocating. Keeps a reference to the model.
class Integrator {
 public:
  Integrator(const model::Model& model, const KernelSet& kernels, int stages);

  struct Run {
    Ending ending = Ending::done;
    const char* reason = "";
    double reached = 0;  // s
    int worst_state = 0;
    Statistics statistics{};
  };

  // From t = 0 to the end of the grid, whose rows go to `rows`, not flushed.
  Run run(Tolerances tolerances, const OutputGrid& grid, RowBlock& rows, const Watch& watch = {});

  // The states at the time reached.

  [[nodiscard]] std::vector<double> state() const;

  [[nodiscard]] std::size_t row_size() const { return row_size_; }

 private:
  struct Free {
    void operator()(void* memory) const;
  };

  const model::Model& model_;
  const Kernel* kernel_;
  std::size_t row_size_;
  double highest_frequency_;
  std::unique_ptr<void, Free> view_;
  std::unique_ptr<void, Free> workspace_;
};

}  // namespace collocation
}  // namespace bbsim::solve
