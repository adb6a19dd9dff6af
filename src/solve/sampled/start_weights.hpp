// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The weight of each nodal value in the node polynomial's value at the start of a piece.
#pragma once

#include "solve/collocation/radau_table.hpp"
#include "solve/sampled/kernel.hpp"

namespace bbsim::solve::sampled {

struct StartWeights {
  double of[nodes]{};

  consteval StartWeights() {
    const auto& c = radau::radau_table<radau::Shared, nodes>.c;
    for (int j = 0; j < nodes; ++j) {
      of[j] = 1;
      for (int k = 0; k < nodes; ++k) {
        if (k != j) of[j] *= c[k] / (c[k] - c[j]);
      }
    }
  }
};

}  // namespace bbsim::solve::sampled
