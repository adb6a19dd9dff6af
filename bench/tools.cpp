#include "tools.hpp"

#include <array>
#include <boost/numeric/odeint.hpp>
#include <cstddef>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include "solve/cvode/cvode.hpp"
#include "solve/integrate.hpp"
#include "solve/radau/radau.hpp"

namespace bbsim::bench {
namespace {

bool run_radau(const Scene& scene, solve::Tolerances tolerances, Rows& rows) {
  return solve::integrate(scene.model, Method::radau, tolerances, scene.grid, rows, {}).ending ==
         solve::Ending::done;
}

template <Method method>
bool run_cvode(const Scene& scene, solve::Tolerances tolerances, Rows& rows) {
  return solve::integrate(scene.model, method, tolerances, scene.grid, rows, {}).ending ==
         solve::Ending::done;
}

// odeint at its best: the right-hand side is the very one that bbsim integrates, for the concrete
// system and inlined (no virtual call, no branch on the kind of scene); the state is an array of
// fixed size, so that nothing is allocated and loops unroll; rows come from the method's own dense
// output, so that output times do not shorten steps; -O3, as all of a release build.
bool run_dopri5(const Scene& scene, solve::Tolerances tolerances, Rows& rows) {
  namespace odeint = boost::numeric::odeint;
  return std::visit(
      [&](const auto& system) {
        using State = std::array<double, std::decay_t<decltype(system)>::size>;
        State z;
        std::copy(scene.model.initial.begin(), scene.model.initial.end(), z.begin());
        const auto rates = [&system](const State& at, State& slope, double t) {
          system.derivative(t, at.data(), slope.data());
        };
        std::size_t next = 0;
        const auto observe = [&](const State& at, double) {
          std::copy(at.begin(), at.end(), rows.row(next++));
        };
        constexpr double first_step = 0.01;  // s; adapted at once
        try {
          odeint::integrate_times(odeint::make_dense_output(tolerances.atol, tolerances.rtol,
                                                            odeint::runge_kutta_dopri5<State>()),
                                  rates, z, scene.times.begin(), scene.times.end(), first_step,
                                  observe);
        } catch (const std::runtime_error&) {  // the step shrank to nothing
          return false;
        }
        return next == scene.grid.size();
      },
      scene.model.system);
}

}  // namespace

const std::vector<Tool>& all_tools() {
  static const std::vector<Tool> tools{{"radau", run_radau},
                                       {"dopri5", run_dopri5},
                                       {"bdf", run_cvode<Method::bdf>},
                                       {"adams", run_cvode<Method::adams>}};
  return tools;
}

}  // namespace bbsim::bench
