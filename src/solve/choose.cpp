#include "solve/choose.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "model/spectrum.hpp"

namespace bbsim::solve {
namespace {

// The fastest decay rate seen over the scene, 1/s: at times across it in open loop, where the
// Jacobian depends on time alone; at the start and about home in closed loop.
double fastest_decay(const model::Model& model, double end) {
  double fastest = 0;
  const auto look = [&](const model::Eigenvalues& values) {
    for (const auto& value : values) fastest = std::max(fastest, -value.real());
  };
  if (model.closed_loop()) {
    look(model::eigenvalues(model, 0, model.initial.data()));
    look(model::closed_loop_poles(model));
  } else {
    constexpr int samples = 8;
    for (int i = 0; i <= samples; ++i) {
      look(model::eigenvalues(model, end * i / samples, model.initial.data()));
    }
  }
  return fastest;
}

}  // namespace

std::string_view method_name(Method method) {
  const auto* named = std::find_if(named_methods.begin(), named_methods.end(),
                                   [method](const auto& entry) { return entry.method == method; });
  return named == named_methods.end() ? "" : named->name;
}

Choice choose_method(const model::Model& model, Method asked, Tolerances tolerances, double end) {
  if (asked != Method::automatic) return {asked, "asked for"};
  // Adams with fixed-point iterations needs about one step a decay time of the fastest mode; BDF
  // needs steps for accuracy alone, more of them by the fifth root of the tolerance. Measured on
  // servo loops of 1 to 2000 rad/s the two cost the same near 100 decay times at rtol 1e-8.
  const double decays = fastest_decay(model, end) * end;
  const double worth_it = 100 * std::pow(1e-8 / tolerances.rtol, 0.2);
  char text[120];
  std::snprintf(text, sizeof text,
                "the fastest mode decays %.3g times over the scene; BDF pays from %.3g", decays,
                worth_it);
  return {decays > worth_it ? Method::bdf : Method::adams, text};
}

}  // namespace bbsim::solve
