// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The keys of `run --sensitivity`, and their columns and summary entries.
#pragma once

#include <string>
#include <vector>

#include "api/run.hpp"
#include "api/simulation.hpp"
#include "file/table_writer.hpp"
#include "scenario/columns.hpp"
#include "study/sensitivity.hpp"

namespace bbsim::api {

// Keys of lists "KEY,KEY". Throws InputError for a key without a number, and for a request that
// does not allow derivatives.
[[nodiscard]] std::vector<study::VariedKey> sensitivity_keys(const RunRequest& request);

// Columns d(x)/d(KEY) for those columns that are states.
struct GradientColumns {
  std::vector<std::string> names, units, meanings;
  // Column and key of each.
  std::vector<const scenario::Column*> of;
  std::vector<std::size_t> keys;

  GradientColumns(const std::vector<const scenario::Column*>& columns,
                  const std::vector<study::VariedKey>& keys);
  void add_headers(std::vector<file::ColumnHeader>& headers) const;
  // Call it after the run.
  [[nodiscard]] std::vector<std::vector<double>> values(
      const study::Sensitivity& sensitivity) const;
};

// Adds the gradients of the first measures to the summary.
void add_gradients(const Simulation& made, const std::vector<scenario::Measure>& measures,
                   const std::vector<study::VariedKey>& keys, record::RunSummary& summary);

}  // namespace bbsim::api
