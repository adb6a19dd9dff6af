// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/hybrid_driver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "base/chebyshev.hpp"
#include "model/hybrid_system.hpp"
#include "solve/pace.hpp"
#include "solve/piece.hpp"
#include "solve/row_block.hpp"
#include "solve/standstill.hpp"

namespace bbsim::solve {
namespace {

using Effect = model::HybridSystem::Effect;

// A velocity below this multiple of the absolute tolerance is near rest: the integrator hardly
// knows its direction.
constexpr double near_rest = 10;

class HybridIntegration {
 public:
  HybridIntegration(const model::Model& model, const MakeStepper& make_stepper,
                    Tolerances tolerances, const OutputGrid& grid, StateSink& sink,
                    const Watch& watch, Part* part)
      : run_(model, near_rest * tolerances.atol),
        grid_(grid),
        watch_(watch),
        part_(part),
        end_row_(part != nullptr ? part->end_row : grid.size()),
        cut_(grid[end_row_ - 1]),
        size_(model.size()),
        plain_size_(model.size() + (model.gamma ? 1 : 0)),
        row_size_(model.row_size()),
        rows_(sink, row_size_, part != nullptr ? part->first_row : 0),
        pace_(grid.end()),
        pieces_(sink.pieces()),
        stepper_(make_stepper(run_.model())),
        controller_(run_.controller()),
        foresees_(stepper_->servos() != nullptr),
        first_guard_(foresees_ ? run_.first_monitor() : 0),
        guards_(run_.guards()),
        values_(run_.guards()),
        now_(run_.guards()),
        near_(run_.guards()),
        least_(run_.guards()),
        most_(run_.guards()),
        row_(plain_size_) {}

  Outcome run() {
    try {
      return run_to_end();
    } catch (const model::ControllerFault& fault) {
      Outcome outcome =
          ended(fault.interrupted() ? Ending::interrupted : Ending::failed, asked_at_);
      outcome.reason = fault.what();
      if (!fault.interrupted()) outcome.why = Why::controller;
      return outcome;
    }
  }

 private:
  struct Guard {
    double value = 0;      // at the last time evaluated
    double slope = 0;      // at the same time, 1/s
    double threshold = 0;  // the guard fires below it; 0 once the guard was positive
  };

  Outcome run_to_end() {
    std::vector<double> z = run_.model().initial;
    if (pieces_ != nullptr) pieces_->begin_run();
    if (part_ != nullptr && !part_->from.empty()) {
      StateReader from(part_->from);
      archive(from);
      if (controller_ != nullptr) {
        std::string memory;
        from(memory);
        controller_->restore(memory);
      }
      stepper_->restore(from);
      next_row_ = part_->first_row;
      begun_ = grid_[next_row_ - 1];
      require_time(from);
      return go_on(z);
    }
    run_.handle_time_event(0, z.data());
    if (run_.unsettled()) return unsettled(0);
    double* const first = rows_.next();
    std::copy(z.begin(), z.end(), first);
    if (plain_size_ > size_) first[size_] = 0;
    finish_row(0, first);
    if (look(0, z, 0) == Effect::stop) return ended(Ending::stopped, 0);
    stepper_->start(0, z.data());
    if (foresees_) {
      foresee(0, z, false);
    } else if (!guards_.empty()) {
      arm(0, z.data());
    }
    return go_on(z);
  }

  // Goes from step to step, starting from the stepper's present state. z is scratch space for one
  // state.
  Outcome go_on(std::vector<double>& z) {
    const double last = step_limit(part_, grid_.end());
    double from = stepper_->time(), limit = from;
    for (std::size_t steps = 1;; ++steps) {
      // An event due at the end may lie a rounding after it.
      const double due = run_.next_time_event();
      const double end = due > last && due - last <= slack(last) ? due : last;
      if (from >= stepper_->time()) {
        // With closed-form servos, a step ends where the motion changes. It ends neither at a
        // sample nor at the run's end, so a longer run has the same steps.
        limit = foresees_ ? std::min(run_.next_change(), fall_.time) : std::min(due, end);
        if (part_ != nullptr && part_->keeps_state) keep_state(limit);
        if (is_stopped()) return ended(Ending::interrupted, from);
        quiet_ = false;
        if (const auto failure = stepper_->step(limit)) {
          if (unlooked_ && look(from, stepper_->state(), turned_) == Effect::stop) {
            return ended(Ending::stopped, from);
          }
          return failed(from, failure->why, failure->text);
        }
      }
      const double to = std::min({stepper_->time(), due, end});
      double at = to;
      told_ = from;
      Effect effect = scan(from, to, at, z);
      if (effect == Effect::none && to >= fall_.time) effect = fall(to, z);
      const bool switches = effect == Effect::restart || (effect == Effect::none && to >= due);
      const bool ends = effect == Effect::none && !switches && to >= end;
      if (effect == Effect::none) tell(to, switches);
      write_rows(at, !switches);
      if (part_ends()) return ended(Ending::done, cut_);
      if (effect == Effect::stop) return ended(Ending::stopped, at);
      if (ends) return ended(Ending::done, at);
      if (switches) {
        if (effect == Effect::none) state_at(at, z);
        const double turned = row_.back();
        asked_at_ = at;
        // True if the motion continues in the same mode from the same state.
        bool goes_on = foresees_ && effect == Effect::none;
        if (run_.is_due(at)) {
          run_.handle_time_event(at, z.data());
          goes_on = goes_on && !run_.touched();
        }
        if (run_.unsettled()) return unsettled(at);
        if (standstill_.after(at))
          return at_switch(at, "the rig switches endlessly at one instant");
        if (goes_on) {
          // The sample changed nothing.
        } else if (run_.model().rig || run_.model().dry) {
          stepper_->start(at, z.data());
        } else {
          // Only an input derivative jumps here. A run with monitors takes the same steps as one
          // without.
          stepper_->jump();
        }
        write_row_at(at, z, turned);
        if (part_ends()) {  // the row at a switch includes what the switch did
          const bool stops = !goes_on && look(at, z, turned) == Effect::stop;
          return stops ? ended(Ending::stopped, at) : ended(Ending::done, cut_);
        }
        const bool over = end - at <= slack(at);
        if (foresees_ && !over) {
          if (!goes_on) turned_ = turned;
          if (!goes_on || foreseen_ < run_.next_change()) foresee(at, z, !goes_on);
        } else if (look(at, z, turned) == Effect::stop) {
          return ended(Ending::stopped, at);
        }
        if (over) return ended(Ending::done, grid_.end());
        if (!foresees_ && !guards_.empty()) arm(at, z.data());
      }
      from = at;
      // A step or state event short of `limit` counts as work. A sample or a stop says nothing
      // about the pace.
      if (at < limit && pace_.creeps(at, [&] { return stopped_at(at); })) {
        Outcome outcome = failed(at, Why::too_slow, pace_.reason());
        if (at >= stepper_->time()) state_at(at, outcome.last_state);
        return outcome;
      }
      if (watch_.slow && pace_.looked() && pace_.is_news()) {
        watch_.slow(at, pace_.steps_per_second(), pace_.steps_left());
      }
      if (watch_.progress && steps % 256 == 0) watch_.progress(at);
    }
  }

  // Whether all rows of this part are written, if it is not the last part.
  [[nodiscard]] bool part_ends() const {
    return part_ != nullptr && next_row_ == end_row_ && end_row_ < grid_.size();
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(run_, pace_);
    archive.fixed(guards_);
    for (const Guard& guard : guards_) {
      archive.require(is_number(guard.value) && is_number(guard.threshold));
    }
    archive(asked_, asked_time_, standstill_, fall_, foreseen_, unlooked_, unarmed_, turned_);
    archive.require(asked_.size() <= guards_.size() && is_finite(asked_time_, turned_) &&
                    is_number(foreseen_) && is_number(fall_.time) &&
                    (std::isinf(fall_.time) || fall_.guard < first_guard_));
  }

  // Requires that a restored time lies before the next row, and that nothing due earlier was left
  // undone.
  void require_time(const StateReader& from) const {
    const double t = stepper_->time(), next = grid_[next_row_];
    StateReader::require(from.at_end() && t >= 0 && t <= next + slack(next) &&
                         run_.next_time_event() >= t - slack(t) && fall_.time >= t - slack(t));
  }

  // Saves the state before a step up to `limit`. Asks an external controller for its memory only if
  // the part may end within this step, or ends now.
  void keep_state(double limit) {
    part_->state.clear();
    StateWriter into;
    archive(into);
    if (controller_ != nullptr) {
      if (limit + slack(limit) < cut_ && !is_stopped()) return;
      std::string memory = controller_->save();
      into(memory);
    }
    if (stepper_->save(into)) part_->state = into.bytes();
  }

  [[nodiscard]] bool is_stopped() const {
    return watch_.stop != nullptr && watch_.stop->load(std::memory_order_relaxed);
  }

  // Times closer than this (s) are the same instant: i * step and n * period round differently.
  [[nodiscard]] double slack(double t) const { return run_.rounding(t); }

  // Sets the guards' start values. A guard that starts at zero, where it last fell, fires once it
  // is clearly below.
  void arm(double t, const double* z) {
    unarmed_ = false;
    run_.evaluate_guards(t, z, values_.data());
    for (std::size_t i = 0; i < guards_.size(); ++i) {
      guards_[i].value = values_[i];
      const double clearly = 1e-12 * run_.guard_scales()[i];
      guards_[i].threshold = values_[i] > clearly ? 0 : std::min(0.0, values_[i]) - clearly;
    }
  }

  void state_at(double t, std::vector<double>& z) {
    stepper_->evaluate(&t, 1, row_.data());
    z.resize(size_);
    std::copy_n(row_.begin(), size_, z.begin());
  }

  // After a switch with closed-form servos: predicts when the next servo guard falls. Monitors wait
  // for the step, whose bounds usually settle what the switch did to them too.
  void foresee(double t, const std::vector<double>& z, bool switched) {
    foreseen_ = run_.next_change();
    // A rig that does not switch has no servo guards.
    fall_ = {};
    if (first_guard_ > 0) {
      fall_ = switched ? run_.next_fall(t, *stepper_->servos(), foreseen_)
                       : run_.next_fall(t, run_.held_motions(z.data()), foreseen_);
    }
    unarmed_ = first_guard_ < guards_.size();
    unlooked_ = unlooked_ || (switched && unarmed_);
  }

  // Handles the predicted fall of a servo guard, at the end of the last step.
  Effect fall(double at, std::vector<double>& z) {
    write_rows(at, false);  // in the mode before the switch
    tell(at, true);
    state_at(at, z);
    const Effect effect = run_.handle_state_event(fall_.guard, at, z.data());
    run_.note_turned(row_.back());
    return effect;
  }

  // Checks the monitors after a switch. `turned`: the integral of u there, m.
  Effect look(double t, const std::vector<double>& z, double turned) {
    const Effect effect = run_.check_events(t, z.data());
    run_.note_turned(turned);
    return effect;
  }

  // Predicts when an event stops the run, s. Extrapolates each guard linearly from its value at the
  // last call.
  double stopped_at(double t) {
    double soonest = std::numeric_limits<double>::infinity();
    asked_.resize(guards_.size());
    if (unarmed_) {
      state_at(t, look_);
      arm(t, look_.data());
    }
    for (std::size_t i = 0; i < guards_.size(); ++i) {
      const double value = guards_[i].value, fallen = asked_[i] - value;
      if (run_.stops(i) && fallen > 0) {
        soonest = std::min(soonest, t + value * (t - asked_time_) / fallen);
      }
      asked_[i] = value;
    }
    asked_time_ = t;
    return soonest;
  }

  // How far guard i is above its threshold at t.
  double above(std::size_t i, double t) {
    state_at(t, look_);
    run_.evaluate_guards(t, look_.data(), values_.data());
    return values_[i] - guards_[i].threshold;
  }

  // The first time in (from, to] at which guard i is not above its threshold. The guard is above it
  // at `from`, and not at `to`. Uses regula falsi, with a bisection after each step that does not
  // halve the bracket.
  double root(std::size_t i, double from, double to) {
    double f_from = above(i, from), f_to = above(i, to);
    bool halve = false;
    for (int k = 0; k < 200; ++k) {
      const double width = to - from;
      if (width <= 2 * std::numeric_limits<double>::epsilon() * std::abs(to)) break;
      double middle = from + width * (f_from / (f_from - f_to));
      if (halve || !(middle > from && middle < to)) middle = from + width / 2;
      if (middle <= from || middle >= to) break;
      const double f = above(i, middle);
      if (f > 0) {
        from = middle;
        f_from = f;
      } else {
        to = middle;
        f_to = f;
      }
      halve = to - from > width / 2;
    }
    return to;
  }

  // Searches for the minimum of guard i within [from, to] by golden sections. Returns a time at
  // which the guard is not above its threshold, or `from` if it finds none.
  double dip(std::size_t i, double from, double to) {
    constexpr double golden = 0.6180339887498949;
    double a = from, b = to;
    double c = b - golden * (b - a), d = a + golden * (b - a);
    double fc = above(i, c), fd = above(i, d);
    for (int k = 0; k < 60 && b - a > 1e-12 * b; ++k) {
      if (fc <= 0) return c;
      if (fd <= 0) return d;
      if (fc < fd) {
        b = d;
        d = c;
        fd = fc;
        c = b - golden * (b - a);
        fc = above(i, c);
      } else {
        a = c;
        c = d;
        fc = fd;
        d = a + golden * (b - a);
        fd = above(i, d);
      }
    }
    return from;
  }

  // Time of point p of the `points` at which scan() evaluates a step from `from` to `to`.
  static double point(std::size_t p, std::size_t points, double from, double to) {
    if (p == points) return to;
    return from + (to - from) * static_cast<double>(p) / static_cast<double>(points);
  }

  // Width of the differences that give slopes, as a fraction of the distance between two points.
  static constexpr double nudged = 1e-4;

  // Evaluates the states at all times that scan() visits if nothing happens. One call for all times
  // fills the SIMD lanes.
  void look_ahead(std::size_t points, double from, double to) {
    planned_times_.clear();
    double last = from;
    for (std::size_t p = 1; p <= points; ++p) {
      const double here = point(p, points, from, to), nudge = (here - last) * nudged;
      planned_times_.insert(planned_times_.end(), {last + nudge, here - nudge, here});
      last = here;
    }
    planned_rows_.resize(planned_times_.size() * plain_size_);
    stepper_->evaluate(planned_times_.data(), planned_times_.size(), planned_rows_.data());
    next_planned_ = 0;
  }

  // Values of all guards at t.
  void look_at(double t, std::vector<double>& values) {
    if (next_planned_ < planned_times_.size() && planned_times_[next_planned_] == t) {
      run_.evaluate_guards(t, &planned_rows_[next_planned_ * plain_size_], values.data());
      ++next_planned_;
      return;
    }
    next_planned_ = planned_times_.size();  // scan() has left the planned times
    state_at(t, look_);
    run_.evaluate_guards(t, look_.data(), values.data());
  }

  // Whether a guard that is positive at both ends of an interval may be negative between: it falls
  // at the start, rises at the end, and its end tangents meet below zero.
  static bool may_dip(const Guard& guard, double end_value, double end_slope, double width) {
    if (guard.threshold != 0 || !(guard.slope < 0) || !(end_slope > 0)) return false;
    const double meet = (end_value - guard.value - end_slope * width) / (guard.slope - end_slope);
    return guard.value + guard.slope * meet <= 0;
  }

  // Whether no guard falls within the step. Bounds each guard by its values at Chebyshev points and
  // by the most that a polynomial can undershoot them. Leaves guards that are not finite to scan().
  bool all_stay_up(double from, double to) {
    const ChebyshevPoints& points = tables_.points(stepper_->parts());
    const std::size_t count = points.size();
    planned_times_.resize(count);
    for (std::size_t p = 0; p < count; ++p) planned_times_[p] = from + (to - from) * points[p];
    planned_times_.back() = to;
    planned_rows_.resize(count * plain_size_);
    stepper_->evaluate(planned_times_.data(), count, planned_rows_.data());
    for (std::size_t i = first_guard_; i < guards_.size(); ++i) {
      if (guards_[i].threshold != 0) return false;  // starts at zero: scan() decides
      least_[i] = most_[i] = guards_[i].value;
    }
    for (std::size_t p = 0; p < count; ++p) {
      run_.evaluate_guards(planned_times_[p], &planned_rows_[p * plain_size_], now_.data());
      for (std::size_t i = first_guard_; i < guards_.size(); ++i) {
        if (std::isnan(now_[i])) return false;
        least_[i] = std::min(least_[i], now_[i]);
        most_[i] = std::max(most_[i], now_[i]);
      }
    }
    for (std::size_t i = first_guard_; i < guards_.size(); ++i) {
      if (std::isinf(least_[i]) && least_[i] > 0) continue;  // not monitored
      if (!(least_[i] - points.overshoot() * (most_[i] - least_[i]) > 0)) return false;
    }
    for (std::size_t i = 0; i < guards_.size(); ++i) guards_[i].value = now_[i];
    return true;
  }

  // Whether the stepper proves that no monitor changes sides within the step. If it does not, this
  // arms the guards at the start of the step. Sets `stops` if an event stops the run there.
  bool settled(double from, std::vector<double>& z, bool& stops) {
    if (first_guard_ == guards_.size() || quiet_) return true;
    quiet_ = stepper_->nothing_happens(run_.happening());
    if (quiet_) {
      unlooked_ = false;
      unarmed_ = true;
      return true;
    }
    if (!unarmed_) return false;
    state_at(from, z);
    stops = unlooked_ && look(from, z, row_.back()) == Effect::stop;
    unlooked_ = false;
    arm(from, z.data());
    return false;
  }

  // Searches the step for guards that fall. Notes occurrences that change nothing on the way. Sets
  // `at` and z at the first one that changes something.
  Effect scan(double from, double to, double& at, std::vector<double>& z) {
    bool stops = false;
    if (guards_.empty() || (foresees_ && settled(from, z, stops))) return Effect::none;
    if (stops) {
      at = from;
      return Effect::stop;
    }
    if (all_stay_up(from, to)) return Effect::none;
    const std::size_t points = stepper_->detail();
    look_ahead(points, from, to);
    double last = from;  // the last time evaluated
    for (std::size_t p = 1; p <= points;) {
      const double here = point(p, points, from, to);
      const double width = here - last, nudge = width * nudged;
      if (!(width > 0)) {
        ++p;
        continue;
      }
      // Slopes at both ends by differences, good to some parts in 1e4.
      look_at(last + nudge, near_);
      for (std::size_t i = first_guard_; i < guards_.size(); ++i) {
        guards_[i].slope = (near_[i] - guards_[i].value) / nudge;
      }
      look_at(here - nudge, near_);
      look_at(here, now_);
      std::size_t first = guards_.size();
      double first_time = here;
      for (std::size_t i = first_guard_; i < guards_.size(); ++i) {
        // An infinite guard is not monitored. If a guard is NaN, the motion overflows, and the
        // stepper reports that.
        if (!std::isfinite(now_[i])) continue;
        double low = here;
        if (now_[i] > guards_[i].threshold) {
          if (!may_dip(guards_[i], now_[i], (now_[i] - near_[i]) / nudge, width)) continue;
          low = dip(i, last, here);
          if (low == last) continue;
        }
        const double t = root(i, last, low);
        if (first == guards_.size() || t < first_time) {
          first = i;
          first_time = t;
        }
      }
      if (first == guards_.size()) {
        for (std::size_t i = 0; i < guards_.size(); ++i) {
          guards_[i].value = now_[i];
          if (now_[i] > 1e-12 * run_.guard_scales()[i]) guards_[i].threshold = 0;
        }
        last = here;
        ++p;
        continue;
      }
      write_rows(first_time, false);  // in the mode before the switch
      tell(first_time, true);
      state_at(first_time, z);
      const Effect effect = run_.handle_state_event(first, first_time, z.data());
      run_.note_turned(row_.back());
      if (effect != Effect::none) {
        at = first_time;
        return effect;
      }
      arm(first_time, z.data());
      last = first_time;
    }
    return Effect::none;
  }

  void finish_row(double t, double* row) {
    if (row_size_ > plain_size_) run_.write_extras(t, row, row + plain_size_);
  }

  // Writes the rows before `to`, and the row at `to` if `with_it`.
  void write_rows(double to, bool with_it) {
    for (; next_row_ < end_row_; ++next_row_) {
      const double t = grid_[next_row_];
      if (t > to || (!with_it && to - t <= slack(to))) break;
      double* const row = rows_.next();
      stepper_->evaluate(&t, 1, row);
      finish_row(t, row);
    }
  }

  // Writes the row at the instant of a switch, with the state after it. The integral of u does not
  // jump. There are several rows if rows are closer than rounding.
  void write_row_at(double at, const std::vector<double>& z, double turned) {
    for (; next_row_ < end_row_ && grid_[next_row_] - at <= slack(at); ++next_row_) {
      double* const row = rows_.next();
      std::copy(z.begin(), z.end(), row);
      if (plain_size_ > size_) row[size_] = turned;
      finish_row(grid_[next_row_], row);
    }
  }

  // A part of the last step, in the present mode.
  class PartOfStep : public Piece {
   public:
    PartOfStep(HybridIntegration& of, double from, double to)
        : Piece(from, to, of.stepper_->parts()), of_(of) {}
    void evaluate(const double* times, std::size_t count, double* rows) const override {
      of_.evaluate_rows(times, count, rows);
    }
    [[nodiscard]] std::optional<Bounds> bounds(Load load, const model::BallConstants& constants,
                                               bool closely) const override {
      return of_.stepper_->bounds(load, constants, closely);
    }

   private:
    HybridIntegration& of_;
  };

  void evaluate_rows(const double* times, std::size_t count, double* rows) {
    plain_rows_.resize(count * plain_size_);
    stepper_->evaluate(times, count, plain_rows_.data());
    for (std::size_t i = 0; i < count; ++i, rows += row_size_) {
      std::copy_n(&plain_rows_[i * plain_size_], plain_size_, rows);
      finish_row(times[i], rows);
    }
  }

  // Hands on the piece up to `to`, before the mode changes.
  void tell(double to, bool switches) {
    if (pieces_ == nullptr) return;
    const double first = std::max(told_, begun_);
    const double last = std::min(switches ? std::nextafter(to, told_) : to, cut_);
    if (last > first) pieces_->accept(PartOfStep(*this, first, last));
    told_ = to;
  }

  Outcome ended(Ending ending, double reached) {
    rows_.flush();
    Outcome outcome;
    outcome.ending = ending;
    if (ending == Ending::stopped) outcome.why = Why::event;
    if (ending == Ending::interrupted) outcome.why = Why::interrupted;
    outcome.reached = reached;
    outcome.rows = rows_.rows();
    outcome.statistics = stepper_->statistics();
    outcome.occurrences = run_.occurrences();
    if (part_ != nullptr) {
      // Two adjacent parts both make the step across their border. Keep only what happens within
      // this part.
      std::erase_if(outcome.occurrences, [&](const model::Occurrence& one) {
        return one.t > cut_ || (!part_->from.empty() && one.t <= begun_);
      });
      // A run that stops in this part has the stopping event among the part's occurrences.
      StateReader::require(ending != Ending::stopped || !outcome.occurrences.empty());
      part_->next_row = next_row_;
      part_->least_end = stepper_->least_end();
      if (ending == Ending::failed || ending == Ending::stopped) part_->state.clear();
    }
    return with_all_rows(std::move(outcome), end_row_);
  }

  // A failure at a switch. The outcome has no states, because the stepper's are from before the
  // switch.
  Outcome at_switch(double reached, std::string reason) {
    Outcome outcome = ended(Ending::failed, reached);
    outcome.why = Why::singular;
    outcome.reason = std::move(reason);
    return outcome;
  }
  Outcome unsettled(double reached) {
    return at_switch(
        reached,
        "the servos' stops and the commands' limits trigger each other endlessly at one instant");
  }

  Outcome failed(double reached, Why why, std::string reason) {
    Outcome outcome = ended(Ending::failed, reached);
    outcome.why = why;
    outcome.reason = std::move(reason);
    outcome.last_state = stepper_->state();
    outcome.worst_state = stepper_->worst_state();
    return outcome;
  }

  model::HybridSystem run_;
  const OutputGrid& grid_;
  const Watch& watch_;
  Part* part_;
  std::size_t end_row_;      // of this part
  double cut_, begun_ = -1;  // times of this part's last row and of the last row before the part
  std::size_t size_, plain_size_, row_size_;
  RowBlock rows_;
  Pace pace_;
  PieceSink* pieces_;
  std::unique_ptr<Stepper> stepper_;
  model::ExternalController* controller_;  // null if the law is built in
  // The stepper moves servos in closed form, and run_ predicts when they switch.
  bool foresees_;
  std::size_t first_guard_;  // the first one that scan() evaluates
  model::HybridSystem::Fall fall_;
  double foreseen_ = 0;  // guard falls are predicted up to here, s
  bool quiet_ = false;   // the stepper proved that nothing happens in the last step
  // Guards have no values at the start of the step; monitors were not checked since a switch.
  bool unarmed_ = false, unlooked_ = false;
  double turned_ = 0;  // integral of u at that switch, m
  std::vector<Guard> guards_;
  ChebyshevTables tables_;
  std::vector<double> values_, now_, near_, least_, most_, look_, row_, planned_times_,
      planned_rows_, plain_rows_;
  std::vector<double> asked_;  // guard values at the last call of stopped_at()
  double asked_time_ = 0;
  std::size_t next_planned_ = 0;
  std::size_t next_row_ = 1;
  double told_ = 0;  // pieces are handed on up to here, s
  Standstill standstill_;
  double asked_at_ = 0;  // the last time event, s
};

}  // namespace

Outcome integrate_hybrid(const model::Model& model, const MakeStepper& make_stepper,
                         Tolerances tolerances, const OutputGrid& grid, StateSink& sink,
                         const Watch& watch, Part* part) {
  return HybridIntegration(model, make_stepper, tolerances, grid, sink, watch, part).run();
}

}  // namespace bbsim::solve
