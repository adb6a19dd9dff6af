// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Part of a run: --save-state, --from-state and --until.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/run.hpp"
#include "file/atomic_file.hpp"
#include "file/table_writer.hpp"
#include "model/model.hpp"
#include "record/run_state.hpp"
#include "scenario/columns.hpp"
#include "scenario/scenario.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/partial_run.hpp"

namespace bbsim::api {

// All members throw InputError if the parts could not match one run bit for bit.
class RunPart {
 public:
  RunPart(const PartRequest& request, const Scenario& scenario,
          const std::vector<file::InputTable>& inputs);

  // Scene for the model; its end is much later if the run's end is not known.
  [[nodiscard]] const Scenario& whole() const { return whole_; }
  // Grid of the whole run.
  [[nodiscard]] const solve::OutputGrid& grid() const { return *grid_; }
  [[nodiscard]] solve::PartialRun& part() { return part_; }

  // Checks the state to continue from, and these columns, before files are opened.
  void check(const model::Model& model, const std::vector<const scenario::Column*>& columns) const;
  void open();
  // Writes the state that the part left. Returns a message about it.
  [[nodiscard]] std::string finish(const model::Model& model);

 private:
  void choose_rows();

  PartRequest request_;
  Scenario whole_;
  std::string identity_;
  std::optional<record::RunState> from_;
  std::optional<solve::OutputGrid> grid_;
  solve::PartialRun part_;
  std::unique_ptr<file::AtomicFile> file_;
};

}  // namespace bbsim::api
