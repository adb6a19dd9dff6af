// Two functions of time with their derivatives: the gimbal's angles, or a reference path.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "model/rolling.hpp"
#include "model/spline.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// A sum of constants, ramps, sinusoids and tables on each of two components.
//
// A sine costs more than the rest of the right-hand side, so sinusoids of one frequency, on
// either component and of any phase, share one: a sin(wt + p) = a cos p sin wt + a sin p cos wt.
class SignalPair {
 public:
  void add_constant(std::size_t component, double value) { start_[component] += value; }
  void add_ramp(std::size_t component, double start, double rate);
  void add_sinusoid(std::size_t component, double amplitude, double frequency, double phase);
  void add_table(std::size_t component, Spline spline);
  void add(std::size_t component, const Profile& profile);

  // Whether a component is zero at all times.
  [[nodiscard]] bool is_zero(std::size_t component) const;

  // Times at which some derivative jumps: the knots of the tables, sorted.
  [[nodiscard]] std::vector<double> knots() const;

  // The largest frequency of a sinusoid, rad/s; 0 if there is none.
  [[nodiscard]] double highest_frequency() const;

  // Both components at time t (s).
  template <class Time>
  [[nodiscard]] std::array<Jet<Time>, 2> at(const Time& t) const {
    std::array<Jet<Time>, 2> jets;
    for (std::size_t i = 0; i < 2; ++i) {
      jets[i] = {start_[i] + rate_[i] * t, Time(rate_[i]), Time(0.0)};
    }
    for (const Harmonic& harmonic : harmonics_) {
      const double w = harmonic.frequency;
      const SinCos<Time> wave = sin_cos(Time(w * t));
      for (std::size_t i = 0; i < 2; ++i) {
        const Time value = harmonic.sine[i] * wave.sin + harmonic.cosine[i] * wave.cos;
        jets[i].value += value;
        jets[i].rate += w * (harmonic.sine[i] * wave.cos - harmonic.cosine[i] * wave.sin);
        jets[i].acceleration -= (w * w) * value;
      }
    }
    for (const Tabulated& table : tables_) {
      const Jet<Time> jet = table.spline.at(t);
      jets[table.component].value += jet.value;
      jets[table.component].rate += jet.rate;
      jets[table.component].acceleration += jet.acceleration;
    }
    return jets;
  }

 private:
  struct Harmonic {
    double frequency;  // rad/s
    std::array<double, 2> sine{0, 0}, cosine{0, 0};
  };
  struct Tabulated {
    std::size_t component;
    Spline spline;
  };

  std::array<double, 2> start_{0, 0}, rate_{0, 0};
  std::vector<Harmonic> harmonics_;
  std::vector<Tabulated> tables_;
};

}  // namespace bbsim::model
