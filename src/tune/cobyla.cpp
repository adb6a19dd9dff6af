// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tune/cobyla.hpp"

#include <dlfcn.h>
#include <nlopt.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <type_traits>

#include "base/error.hpp"

namespace bbsim::tune {
namespace {

// The functions of NLopt that are used.
struct Library {
  decltype(&nlopt_create) create;
  decltype(&nlopt_destroy) destroy;
  decltype(&nlopt_set_lower_bounds) set_lower_bounds;
  decltype(&nlopt_set_upper_bounds) set_upper_bounds;
  decltype(&nlopt_set_min_objective) set_objective;
  decltype(&nlopt_add_inequality_mconstraint) add_constraints;
  decltype(&nlopt_set_initial_step1) set_step;
  decltype(&nlopt_set_xtol_abs1) set_tolerance;
  decltype(&nlopt_set_maxeval) set_most;
  decltype(&nlopt_force_stop) stop;
  decltype(&nlopt_optimize) optimize;
};

Library load() {
  constexpr const char* file = BBSIM_NLOPT_LIBRARY;
  // Never closed, because the process may tune again.
  void* const library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  const auto fail = [&] {
    throw InputError(std::string("the optimizer NLopt cannot be loaded: ") + dlerror() +
                     "; install NLopt 2, such as Debian's libnlopt0");
  };
  if (library == nullptr) fail();
  Library found{};
  const auto get = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
    if (function == nullptr) fail();
  };
  get(found.create, "nlopt_create");
  get(found.destroy, "nlopt_destroy");
  get(found.set_lower_bounds, "nlopt_set_lower_bounds");
  get(found.set_upper_bounds, "nlopt_set_upper_bounds");
  get(found.set_objective, "nlopt_set_min_objective");
  get(found.add_constraints, "nlopt_add_inequality_mconstraint");
  get(found.set_step, "nlopt_set_initial_step1");
  get(found.set_tolerance, "nlopt_set_xtol_abs1");
  get(found.set_most, "nlopt_set_maxeval");
  get(found.stop, "nlopt_force_stop");
  get(found.optimize, "nlopt_optimize");
  return found;
}

const Library& library() {
  static const Library loaded = load();
  return loaded;
}

// NLopt asks for value and constraints in separate calls. No exception may pass through its C code.
struct Calls {
  const Cobyla& search;
  nlopt_opt of = nullptr;
  std::vector<double> x{};
  double value = 0;
  std::vector<double> constraints{};
  std::exception_ptr failure{};
  bool ended = false;

  void evaluate(unsigned count, const double* at) {
    if (ended || (x.size() == count && std::equal(x.begin(), x.end(), at))) return;
    x.assign(at, at + count);
    constraints.resize(search.constraints);
    try {
      ended = !search.function(x, value, constraints.data());
    } catch (...) {
      failure = std::current_exception();
      ended = true;
    }
    if (ended) library().stop(of);
  }
};

double value_of(unsigned count, const double* x, double*, void* data) {
  auto& calls = *static_cast<Calls*>(data);
  calls.evaluate(count, x);
  return calls.value;
}

void constraints_of(unsigned constraints, double* result, unsigned count, const double* x, double*,
                    void* data) {
  auto& calls = *static_cast<Calls*>(data);
  calls.evaluate(count, x);
  std::copy_n(calls.constraints.begin(), constraints, result);
}

}  // namespace

void minimize(const Cobyla& search, std::vector<double> x) {
  const Library& nlopt = library();
  const std::unique_ptr<nlopt_opt_s, decltype(nlopt.destroy)> owned(
      nlopt.create(NLOPT_LN_COBYLA, static_cast<unsigned>(x.size())), nlopt.destroy);
  const nlopt_opt of = owned.get();
  if (of == nullptr) throw std::bad_alloc();
  Calls calls{search, of};
  nlopt.set_lower_bounds(of, search.lower.data());
  nlopt.set_upper_bounds(of, search.upper.data());
  nlopt.set_objective(of, value_of, &calls);
  if (search.constraints > 0) {
    nlopt.add_constraints(of, static_cast<unsigned>(search.constraints), constraints_of, &calls,
                          nullptr);
  }
  nlopt.set_step(of, search.step);
  nlopt.set_tolerance(of, search.tolerance);
  nlopt.set_most(of, static_cast<int>(search.most));
  double least = 0;
  // Ignores the result, which is the reason for ending: search.function remembers the best point.
  static_cast<void>(nlopt.optimize(of, x.data(), &least));
  if (calls.failure) std::rethrow_exception(calls.failure);
}

}  // namespace bbsim::tune
