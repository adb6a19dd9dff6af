// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Drives a stepper through a scene that switches, samples or watches for events.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "solve/hybrid/guard_search.hpp"
#include "solve/hybrid/hybrid_rows.hpp"
#include "solve/pace.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {
namespace {

using model::Effect;

// A velocity below this multiple of the absolute tolerance counts as near rest: the error of the
// integrator hides its direction.
constexpr double near_rest = 10;

class HybridIntegration : public HybridRun {
 public:
  HybridIntegration(const model::Model& model, const MakeStepper& make_stepper,
                    Tolerances tolerances, const OutputGrid& grid, StateSink& sink,
                    const Watch& watch)
      : run_(model, near_rest * tolerances.atol),
        grid_(grid),
        watch_(watch),
        pace_(grid.end()),
        stepper_(make_stepper(run_.model())),
        in_closed_form_(stepper_->servos() != nullptr),
        rows_(run_, *stepper_, grid, sink),
        guards_(run_, *stepper_),
        z_(run_.model().initial) {}

  std::optional<Outcome> advance() override {
    try {
      while (act(state_)) {
        if (waits_) return {};
        state_ = after(state_);
      }
    } catch (const model::ControllerFault& fault) {
      end(fault.interrupted() ? Ending::interrupted : Ending::failed, asked_at_);
      outcome_.reason = fault.what();
      if (!fault.interrupted()) outcome_.why = Why::controller;
    }
    return std::move(outcome_);
  }

 private:
  enum class State {
    start,   // handle what is due at t = 0
    step,    // make a step of the integrator
    search,  // find what happens first in the rest of the step
    jump,    // handle the switch at at_, and restart the integrator
    advance  // continue from at_
  };

  // All transitions. Actions return false if they end the run.
  [[nodiscard]] State after(State state) const {
    switch (state) {
      case State::start:
        return State::step;
      case State::step:
        return State::search;
      case State::search:
        return switches_ ? State::jump : State::advance;
      case State::jump:
        return State::advance;
      case State::advance:
        break;
    }
    return from_ < stepper_->time() ? State::search : State::step;
  }

  bool act(State state) {
    switch (state) {
      case State::start:
        return start();
      case State::step:
        return step();
      case State::search:
        return search();
      case State::jump:
        return jump();
      case State::advance:
        break;
    }
    return move_on();
  }

  // Handles what is due at t. Returns false if the controller has no answer yet: then the present
  // state is tried again.
  bool handle_time_event(double t) {
    waits_ = !run_.handle_time_event(t, z_.data());
    return !waits_;
  }

  bool start() {
    if (!handle_time_event(0)) return true;
    if (run_.unsettled()) return fail_unsettled(0);
    rows_.write_first(z_);
    if (check_events(0, 0) == Effect::stop) return end(Ending::stopped, 0);
    stepper_->start(0, z_.data());
    if (in_closed_form_) {
      predict_crossing(0, false);
    } else {
      guards_.arm(0, z_.data());
    }
    return true;
  }

  // Makes a step, at most to the next known event.
  bool step() {
    // With closed-form servos, a step ends only where the motion changes, not at a sample or at the
    // run's end. A longer run therefore has the same steps.
    const double due = run_.next_time_event();
    limit_ = in_closed_form_ ? std::min(run_.next_change(), crossing_.time)
                             : std::min(due, end_before(due));
    if (is_stopped()) return end(Ending::interrupted, from_);
    guards_.begin_step();
    const auto failure = stepper_->step(limit_);
    if (!failure) return true;
    if (guards_.unchecked()) {
      z_ = stepper_->state();
      if (check_events(from_, switch_integral_) == Effect::stop) return end(Ending::stopped, from_);
    }
    return fail(from_, failure->why, failure->text);
  }

  // The end of the run, or the time of an event that is due there but rounded to just after it.
  [[nodiscard]] double end_before(double due) const {
    const double last = grid_.end();
    return due > last && due - last <= slack(last) ? due : last;
  }

  // Searches the step from from_ up to the next time event. Sets at_, and z_ if a guard crossed.
  bool search() {
    due_ = run_.next_time_event();
    end_ = end_before(due_);
    const double to = std::min({stepper_->time(), due_, end_});
    published_ = from_;
    at_ = to;
    effect_ = search_guards(to);
    if (effect_ == Effect::none && to >= crossing_.time) effect_ = cross(to, crossing_.guard);
    switches_ = effect_ == Effect::restart || (effect_ == Effect::none && to >= due_);
    if (effect_ == Effect::none) publish(to, switches_);
    rows_.write_to(at_, !switches_);
    if (effect_ == Effect::stop) return end(Ending::stopped, at_);
    return switches_ || to < end_ || end(Ending::done, at_);
  }

  // Handles the guards that cross up to `to`, until one changes the motion. Sets at_ to its time.
  Effect search_guards(double to) {
    // Guards may depend on the reference, which must not jump within the search.
    const model::Model& model = run_.model();
    const double until = model.jumps_at(to) ? std::max(from_, model.just_before(to)) : to;
    if (guards_.begin(from_, until) == Effect::stop) {
      at_ = from_;
      return Effect::stop;
    }
    while (const auto crossing = guards_.next()) {
      const Effect effect = cross(crossing->time, crossing->guard);
      if (effect != Effect::none) {
        at_ = crossing->time;
        return effect;
      }
      guards_.resume(crossing->time, z_.data());
    }
    return Effect::none;
  }

  Effect cross(double t, std::size_t guard) {
    rows_.write_to(t, false);  // in the mode before the switch
    publish(t, true);
    integral_ = guards_.state_at(t, z_);
    const Effect effect = run_.handle_state_event(guard, t, z_.data());
    run_.log().note_turned(integral_);
    return effect;
  }

  // Handles time events at at_. Restarts the integrator if the motion changed.
  bool jump() {
    if (effect_ == Effect::none) integral_ = guards_.state_at(at_, z_);
    asked_at_ = at_;
    // Whether the motion continues in the same mode from the same state.
    bool goes_on = in_closed_form_ && effect_ == Effect::none;
    if (run_.is_due(at_)) {
      if (!handle_time_event(at_)) return true;
      goes_on = goes_on && !run_.touched();
    }
    if (run_.unsettled()) return fail_unsettled(at_);
    if (standstill_.after(at_)) {
      return fail_at_switch(at_, "the rig switches endlessly at one instant");
    }
    if (!goes_on) {
      // Without a rig or dry friction, only an input derivative jumps. A run with monitors then
      // takes the same steps as one without.
      if (run_.model().rig || run_.model().dry) {
        stepper_->start(at_, z_.data());
      } else {
        stepper_->jump();
      }
    }
    rows_.write_at(at_, z_, integral_);
    const bool over = end_ - at_ <= slack(at_);
    if (in_closed_form_ && !over && !run_.stops()) {
      if (!goes_on) switch_integral_ = integral_;
      if (!goes_on || predicted_to_ < run_.next_change()) predict_crossing(at_, !goes_on);
      return true;
    }
    if (check_events(at_, integral_) == Effect::stop) return end(Ending::stopped, at_);
    if (over) return end(Ending::done, grid_.end());
    guards_.arm(at_, z_.data());
    return true;
  }

  // Continues from at_, unless the run is too slow.
  bool move_on() {
    from_ = at_;
    // Count only steps and state events before limit_. Samples and stops say nothing about the
    // pace.
    if (at_ < limit_ && pace_.creeps(at_, [&] { return guards_.predicted_stop(at_); })) {
      fail(at_, Why::too_slow, pace_.reason());
      // After a switch, the stepper has no step to evaluate, and its state is at_'s.
      if (!switches_ && at_ >= stepper_->time()) guards_.state_at(at_, outcome_.last_state);
      return false;
    }
    if (watch_.slow && pace_.completed_window() && pace_.is_news()) {
      watch_.slow(at_, pace_.steps_per_second(), pace_.steps_left());
    }
    if (watch_.progress && ++advances_ % 256 == 0) watch_.progress(at_);
    return true;
  }

  // Predicts the next crossing of a closed-form servo's guard, from z_ at t. A rig that does not
  // switch has no such guards.
  void predict_crossing(double t, bool switched) {
    predicted_to_ = run_.next_change();
    crossing_ = {};
    if (run_.first_monitor() > 0) {
      model::Servos& servos = *run_.servos();
      crossing_ = servos.next_crossing(
          t, switched ? *stepper_->servos() : servos.held_motions(t, z_.data()), predicted_to_);
    }
    if (switched) {
      guards_.after_switch();
    } else {
      guards_.forget();
    }
  }

  // Checks the monitors for z_ after a switch.
  Effect check_events(double t, double integral) {
    const Effect effect = run_.check_events(t, z_.data());
    run_.log().note_turned(integral);
    return effect;
  }

  void publish(double to, bool switches) {
    rows_.publish(published_, to, switches);
    published_ = to;
  }

  [[nodiscard]] bool is_stopped() const {
    return watch_.stop != nullptr && watch_.stop->load(std::memory_order_relaxed);
  }

  // Times closer than this (s) are the same instant: i * step and n * period round differently.
  [[nodiscard]] double slack(double t) const { return run_.rounding(t); }

  // The functions that end a run set outcome_ and return false.
  bool end(Ending ending, double reached) {
    rows_.flush();
    Outcome outcome;
    outcome.ending = ending;
    if (ending == Ending::stopped) outcome.why = Why::event;
    if (ending == Ending::interrupted) outcome.why = Why::interrupted;
    outcome.reached = reached;
    outcome.rows = rows_.count();
    outcome.statistics = stepper_->statistics();
    outcome.occurrences = run_.log().occurrences();
    outcome_ = with_all_rows(std::move(outcome), grid_.size());
    return false;
  }

  bool fail(double reached, Why why, std::string reason) {
    fail_at_switch(reached, std::move(reason));
    outcome_.why = why;
    outcome_.last_state = stepper_->state();
    outcome_.worst_state = stepper_->worst_state();
    return false;
  }
  // Ends the run as failed at a switch. Reports no states, because the stepper's are from before
  // the switch.
  bool fail_at_switch(double reached, std::string reason) {
    end(Ending::failed, reached);
    outcome_.why = Why::singular;
    outcome_.reason = std::move(reason);
    return false;
  }
  bool fail_unsettled(double reached) {
    return fail_at_switch(
        reached,
        "the servos' stops and the commands' limits trigger each other endlessly at one instant");
  }

  State state_ = State::start;
  bool waits_ = false;  // for an answer of the controller
  model::HybridSystem run_;
  const OutputGrid& grid_;
  const Watch& watch_;
  Pace pace_;
  std::unique_ptr<Stepper> stepper_;
  bool in_closed_form_;  // the stepper moves the servos, and run_ predicts their crossings
  HybridRows rows_;
  GuardSearch guards_;
  std::vector<double> z_;
  // Times, s: the search's start and result, the step's limit, the next time event and the end.
  double from_ = 0, at_ = 0, limit_ = 0, due_ = 0, end_ = 0;
  Effect effect_ = Effect::none;  // result of the search
  bool switches_ = false;         // the search ended at a switch
  double integral_ = 0;           // integral of u at at_, m
  double switch_integral_ = 0;    // the same at the last switch, for a late check of monitors
  model::Crossing crossing_;      // the next one of a servo's guard
  double predicted_to_ = 0;       // crossings are predicted up to here, s
  double published_ = 0;          // the motion is published up to here, s
  Standstill standstill_;
  double asked_at_ = 0;  // when a controller may last have been asked, s
  std::size_t advances_ = 0;
  Outcome outcome_;
};

}  // namespace

std::unique_ptr<HybridRun> begin_hybrid(const model::Model& model, const MakeStepper& make_stepper,
                                        Tolerances tolerances, const OutputGrid& grid,
                                        StateSink& sink, const Watch& watch) {
  return std::make_unique<HybridIntegration>(model, make_stepper, tolerances, grid, sink, watch);
}

}  // namespace bbsim::solve
