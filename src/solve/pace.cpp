// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/pace.hpp"

#include <cstdio>

namespace bbsim::solve {

bool Pace::judge(double time, double event) {
  double& before = advances_[windows_++ % advances_.size()];
  advance_ = time - from_;
  from_ = time;
  const double taken = static_cast<double>(steps_), of_window = static_cast<double>(window);
  // Not finite if the steps are so short that time stands still.
  const double needed = taken + (end_ - time) / advance_ * of_window;
  const bool out_of_reach = !(needed <= most_steps);
  shrinking_ = out_of_reach && advance_ < 0.9 * before ? shrinking_ + 1 : 0;
  before = advance_;
  // Steps near the rounding of the time are not a transient. Their windows count eight times.
  const bool near_rounding = advance_ < 1e-12 * of_window * time;
  slow_ = out_of_reach ? slow_ + (near_rounding ? 8 : 1) : 0;
  if (taken > most_steps) return true;
  if (shrinking_ < most_shrinking && slow_ < most_slow) return false;
  return !(event - time <= soon * advance_) || ++awaited_ > most_awaited;
}

std::string Pace::reason() const {
  char text[120];
  std::snprintf(text, sizeof text,
                "the steps became so short that the run would never end: the last %zu of them "
                "advanced it by %.2g s",
                window, advance_);
  return text;
}

}  // namespace bbsim::solve
