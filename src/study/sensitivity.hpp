// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The derivatives of a run by keys of its scenario (docs/explanation/sensitivity.md).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/ball/dynamics.hpp"
#include "model/model.hpp"
#include "record/piece_fan.hpp"
#include "scenario/columns.hpp"
#include "scenario/measures.hpp"
#include "scenario/scenario.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/piece.hpp"
#include "study/neighbors.hpp"
#include "study/stage_choice.hpp"
#include "study/switches.hpp"

namespace bbsim::study {

// The smallest form of the model that covers the effects of all keys.
[[nodiscard]] model::Form form_for(const Scenario& scenario, const std::vector<VariedKey>& keys);

// Integrates S = dz/dp beside a run. Along each piece of the run,
//     S' = J S + df/dp
// is linear in S. Radau IIA collocation solves it with one factored matrix for all keys. J is
// exact. df/dp is a difference with the state held: of order 8 between models at eight values of
// the key, or of a lower order if that is as good. f is smooth in p, so a wide difference is
// accurate to rounding. S jumps where the scene switches (switches.hpp).
class Sensitivity : public solve::StateSink, public solve::PieceSink {
 public:
  // `model` has the form `form`. All references must outlive this object. Throws InputError if the
  // model has parts without derivatives, or if a key changes more than the model's numbers. Events
  // may observe the motion and end it; the ends of measures then move, too.
  Sensitivity(const model::Model& model, model::Form form, const solve::OutputGrid& grid,
              std::vector<VariedKey> keys);
  Sensitivity(const Sensitivity&) = delete;  // fan_ refers to this
  Sensitivity& operator=(const Sensitivity&) = delete;

  [[nodiscard]] std::size_t keys() const { return keys_.size(); }

  // Passes the run's rows and pieces to `next`. `with_measures`: measure_gradients() will follow.
  void begin(solve::StateSink& next, bool with_measures);

  void accept(std::size_t first, std::size_t count, const double* values) override;
  [[nodiscard]] solve::PieceSink* pieces() override { return fan_.sink(); }
  void begin_run() override;
  void accept(const solve::Piece& piece) override;

  // After the run: the derivatives of a column in each row.
  [[nodiscard]] std::vector<double> column_gradient(const scenario::Column& column,
                                                    std::size_t key) const;
  // After the run: the derivatives of measures; NaN if there is none.
  [[nodiscard]] std::vector<double> measure_gradients(
      const std::vector<scenario::Measure>& measures, std::size_t key,
      const solve::Outcome& outcome) const;

 private:
  // The motion over a part of a piece. Column i of `values` has the row at node i, followed by the
  // row's derivatives by each key.
  struct Arc {
    double from, to;
    Eigen::MatrixXd values;
    // How far each key moves the switch at `to`; empty if there is none.
    Eigen::VectorXd to_moves{};
  };
  // The scene at value + offset `change` for the offsets -2, -1, 1, 2.
  struct Changed {
    double change;
    std::vector<model::Model> models;
    std::vector<model::BallConstants> constants;
  };

  void fill(Neighbors& neighbors) const;
  void choose_step(Neighbors& neighbors) const;
  [[nodiscard]] double roughness(const Neighbors& neighbors) const;
  [[nodiscard]] std::size_t least_pairs(const Neighbors& neighbors) const;
  void require_alike(const model::Model& other, const std::string& key) const;
  void cross(const solve::Piece& piece, double from, double to, int depth);
  [[nodiscard]] bool step(const solve::Piece& piece, double from, double to, std::size_t choice,
                          bool last_try);
  void take_rows(double from, double to, const Eigen::MatrixXd& values);
  void pass(double t, const Eigen::VectorXd& after);
  [[nodiscard]] const model::System& system() const;
  [[nodiscard]] Eigen::VectorXd state_rates(double t, const Eigen::VectorXd& row) const;
  void add_forcing(const Neighbors& neighbors, double t, const double* z, double* into) const;
  [[nodiscard]] Changed changed(std::size_t key) const;
  [[nodiscard]] std::vector<double> changed_rows(std::size_t key, double change) const;
  [[nodiscard]] const Arc* arc_at(double t) const;
  [[nodiscard]] double room_at_end(std::size_t arc) const;
  [[nodiscard]] double switch_moves(std::size_t arc, std::size_t key) const;
  [[nodiscard]] std::optional<solve::Outcome> moved(const solve::Outcome& outcome, std::size_t key,
                                                    double change,
                                                    const model::Model& changed) const;
  [[nodiscard]] Eigen::MatrixXd moved_values(const Arc& arc, std::size_t key, double change) const;
  [[nodiscard]] std::size_t rows() const;

  const model::Model& model_;
  model::Form form_;
  const solve::OutputGrid& grid_;
  // Sizes of S (the states, and r gamma if it is integrated) and of a row, which may have extras.
  Eigen::Index size_, row_;
  int spin_;  // the state u = r gamma', or -1
  std::vector<Neighbors> keys_;
  std::unique_ptr<Switches> switches_;  // null if the scene does not switch
  Eigen::MatrixXd initial_;             // S at t = 0, one column per key

  solve::StateSink* next_ = nullptr;
  record::PieceFan fan_;
  bool keeps_arcs_ = false;
  StageChoice stages_;
  Eigen::MatrixXd slopes_;   // S at the time reached
  Eigen::MatrixXd largest_;  // the greatest absolute value of each number of S so far
  // If the scene switches: the run, and the states and their rates at the time reached.
  const model::HybridSystem* run_ = nullptr;
  Eigen::VectorXd reached_, rates_;
  std::size_t next_row_ = 0;
  std::vector<double> states_;     // row after row
  std::vector<double> gradients_;  // for each row, key after key
  std::vector<Arc> arcs_;
};

}  // namespace bbsim::study
