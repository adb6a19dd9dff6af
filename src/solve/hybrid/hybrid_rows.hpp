// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The output of a run with switches: its rows, and its motion between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "model/hybrid/hybrid_system.hpp"
#include "solve/row_block.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {

class HybridRows {
 public:
  HybridRows(model::HybridSystem& run, Stepper& stepper, const OutputGrid& grid, StateSink& sink)
      : run_(run),
        stepper_(stepper),
        grid_(grid),
        size_(run.model().size()),
        plain_size_(size_ + (run.model().gamma ? 1 : 0)),
        row_size_(run.model().row_size()),
        rows_(sink, row_size_),
        pieces_(sink.pieces()) {
    if (pieces_ != nullptr) pieces_->begin_run();
  }

  // Writes the rows before `to`, and the row at `to` if `with_it`, in the present mode.
  void write_to(double to, bool with_it) {
    for (; next_row_ < grid_.size(); ++next_row_) {
      const double t = grid_[next_row_];
      if (t > to || (!with_it && to - t <= run_.rounding(to))) break;
      double* const row = rows_.next();
      stepper_.evaluate(&t, 1, row);
      finish(t, row);
    }
  }

  // Writes the row at the instant of a switch, with the state after it. `integral`: that of u,
  // which does not jump. Writes several rows if they are closer than rounding.
  void write_at(double at, const std::vector<double>& z, double integral) {
    for (; next_row_ < grid_.size() && grid_[next_row_] - at <= run_.rounding(at); ++next_row_) {
      write(grid_[next_row_], z, integral);
    }
  }
  void write_first(const std::vector<double>& z) { write(0, z, 0); }

  // Publishes the motion from `from`, where the last call ended, to `to`. Call it before the mode
  // changes. `switches`: `to` is excluded.
  void publish(double from, double to, bool switches) {
    if (pieces_ == nullptr) return;
    const double last = std::min(switches ? run_.model().just_before(to) : to, grid_.end());
    if (last > from) pieces_->accept(PartOfStep(*this, from, last));
  }

  void flush() { rows_.flush(); }
  [[nodiscard]] std::size_t count() const { return rows_.rows(); }

 private:
  // A part of the last step, in the present mode.
  class PartOfStep : public Piece {
   public:
    PartOfStep(HybridRows& of, double from, double to)
        : Piece(from, to, of.stepper_.parts()), of_(of) {}
    void evaluate(const double* times, std::size_t count, double* rows) const override {
      of_.plain_rows_.resize(count * of_.plain_size_);
      of_.stepper_.evaluate(times, count, of_.plain_rows_.data());
      spread(count, rows);
      for (std::size_t i = 0; i < count; ++i) of_.finish(times[i], rows + i * of_.row_size_);
    }
    void evaluate_ball(const double* times, std::size_t count, double* rows) const override {
      of_.plain_rows_.resize(count * of_.plain_size_);
      of_.stepper_.evaluate_ball(times, count, of_.plain_rows_.data());
      spread(count, rows);
    }
    [[nodiscard]] std::optional<Bounds> bounds(Bounded column,
                                               const model::BallConstants& constants,
                                               bool closely) const override {
      return of_.stepper_.bounds(column, constants, closely);
    }

   private:
    void spread(std::size_t count, double* rows) const {
      for (std::size_t i = 0; i < count; ++i) {
        std::copy_n(&of_.plain_rows_[i * of_.plain_size_], of_.plain_size_,
                    rows + i * of_.row_size_);
      }
    }

    HybridRows& of_;
  };

  void write(double t, const std::vector<double>& z, double integral) {
    double* const row = rows_.next();
    std::copy(z.begin(), z.end(), row);
    if (plain_size_ > size_) row[size_] = integral;
    finish(t, row);
  }
  void finish(double t, double* row) {
    if (row_size_ > plain_size_) run_.write_extras(t, row, row + plain_size_);
  }

  model::HybridSystem& run_;
  Stepper& stepper_;
  const OutputGrid& grid_;
  std::size_t size_, plain_size_, row_size_;  // of states; with the integral of u; of a whole row
  RowBlock rows_;
  PieceSink* pieces_;
  std::size_t next_row_ = 1;
  std::vector<double> plain_rows_;
};

}  // namespace bbsim::solve
