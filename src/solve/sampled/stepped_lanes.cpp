// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/stepped_lanes.hpp"

#include <algorithm>

namespace bbsim::solve::sampled {

SteppedLanes::SteppedLanes(Tolerances tolerances) : LaneEngine(tolerances) {
  for (std::size_t l = 0; l < group; ++l) clear(l);
}

void SteppedLanes::begin(std::size_t l, const model::Model& model, double end) {
  drop(l);
  // Rigs that begin together must not depend on earlier rigs.
  if (std::ranges::none_of(lanes_, &Lane::alive)) {
    forget_tables();
    make_room(model);
  }
  if (!has_room(model)) return this->end(l, State::given_up);
  open(l, model, end, true);
  lanes_[l].alive = true;
  ask(l);
}

void SteppedLanes::drop(std::size_t l) {
  end(l, State::empty);
}

void SteppedLanes::end(std::size_t l, State how) {
  states_[l] = how;
  lanes_[l].alive = lanes_[l].moved = lanes_[l].waits = asks_[l] = false;
  searches_[l].reset();
}

// Takes the sample that is due, and waits for its command.
void SteppedLanes::ask(std::size_t l) {
  Lane& lane = lanes_[l];
  LaneSample& now = samples_[l];
  asks_[l] = false;
  lane.run->observe(lane.time, lane.z.data());
  model::Sampling& sampling = *lane.run->sampling();
  now.seen = sampling.begin(lane.run->instant_end(lane.time));
  now.reference = sampling.reference_at(lane.time);
  const double* const angles = lane.z.data() + model::RigLayout::angle;
  const double* const rates = angles + lane.plate->servos();
  double servo[4] = {angles[0], angles[1], rates[0], rates[1]};
  const model::Mechanism& mechanism = lane.run->model().rig->mechanism;
  if (mechanism.three) mechanism.believed(angles, rates, servo);
  now.servo = {servo[0], servo[1]};
  now.servo_rate = {servo[2], servo[3]};
  lane.waits = true;
  kept_[l] = pieces_->contraction[l];
  states_[l] = State::waits;
}

bool SteppedLanes::is_at_end(std::size_t l) const {
  const Lane& lane = lanes_[l];
  return lane.end - lane.time <= lane.run->rounding(lane.time);
}

void SteppedLanes::answer(std::size_t l, const Pair& command) {
  Lane& lane = lanes_[l];
  const double t = lane.time;
  model::Sampling& sampling = *lane.run->sampling();
  sampling.end(sampling.controller().within_limits(command),
               samples_[l].seen.value_or(sampling.measured()));
  lane.run->act(t, lane.z.data());
  const bool begins = t == 0, touched = lane.run->touched();
  const bool over = is_at_end(l);
  if (lane.run->unsettled()) return end(l, State::given_up);
  if (lane.run->stops()) return end(l, State::stopped);
  if ((begins || over) && lane.run->check_events(t, lane.z.data()) == model::Effect::stop) {
    return end(l, State::stopped);
  }
  if (over) return end(l, State::done);
  lane.waits = false;
  pieces_->contraction[l] = kept_[l];
  if (!touched) return;
  if (searches_[l]) searches_[l]->after_switch();
  if (!lane.run->only_commanded() && lane.standstill.after(t)) return end(l, State::given_up);
  if (begins || !lane.run->only_commanded()) {
    start(l);
  } else {
    put_start(l);
    take_commands(l);
    lane.unpredicted = true;
  }
}

void SteppedLanes::advance() {
  const auto limit_of = [](const Lane& lane) {
    const double change = lane.run->next_change(), sample = lane.run->sampling()->next_sample();
    // Both may be one instant. The command's time then counts.
    return sample < change && !lane.run->changes_at(sample) ? sample : change;
  };
  while (plan(limit_of)) {
    kernels_.attempt(*pieces_, scene_);
    judge();
    evaluate_quantities();
    pass_instants();
    for (std::size_t l = 0; l < group; ++l) {
      if (lanes_[l].moved) {
        if (searches_[l]) {
          lanes_[l].restarts ? searches_[l]->after_switch() : searches_[l]->forget();
        }
        go_on(l);
        if (lanes_[l].switched && searches_[l]) searches_[l]->after_switch();
      }
      if (lanes_[l].alive && asks_[l]) ask(l);
    }
  }
  for (std::size_t l = 0; l < group; ++l) {
    if (states_[l] == State::waits && !lanes_[l].alive) end(l, State::given_up);
  }
}

void SteppedLanes::evaluate_quantities() {
  static const LaneReference none{};  // unused: scene_.reference is false
  kernels_.evaluate_quantities(*pieces_, scene_, none, step_.quantities_);
  for (std::size_t l = 0; l < group; ++l) {
    if (!step_.has_[l]) continue;
    const std::vector<char>& occurring = lanes_[l].run->occurring();
    if (is_quiet(l) && std::find(occurring.begin(), occurring.end(), 1) == occurring.end()) {
      searches_[l].reset();
    } else {
      search(l);
    }
  }
}

// Finds the events within a lane's piece.
void SteppedLanes::search(std::size_t l) {
  Lane& lane = lanes_[l];
  GuardSearch& search = search_in(l);
  search.begin_step();
  if (search.begin(lane.time, step_.to(l)) == model::Effect::stop) return end(l, State::stopped);
  while (const auto crossing = search.next()) {
    search.state_at(crossing->time, found_);
    if (lane.run->handle_state_event(crossing->guard, crossing->time, found_.data()) ==
        model::Effect::stop) {
      return end(l, State::stopped);
    }
    search.resume(crossing->time, found_.data());
  }
}

// Handles exposures and commands, each at its time, up to samples or the ends of the pieces.
void SteppedLanes::pass_instants() {
  const auto end_time = [this](std::size_t l) { return lanes_[l].end; };
  NextInstants next;
  while (find_instants(end_time, next)) {
    for (std::size_t l = 0; l < group; ++l) {
      Lane& lane = lanes_[l];
      if (!lane.moved || lane.settled) continue;
      const double t = next.when[l];
      if (next.is_event[l] && lane.run->samples_at(t)) {
        asks_[l] = lane.settled = true;
        continue;
      }
      const bool over = lane.end - t <= lane.run->rounding(t);
      state_at(l, t, next.ball, over);
      if (next.is_event[l]) {
        lane.run->observe(t, lane.z.data());
        lane.run->act(t, lane.z.data());
        lane.restarts = lane.settled = lane.run->touched();
        lane.switched = lane.switched || !lane.run->only_commanded();
        if (lane.restarts) lane.until = t;
      }
      if (!over) continue;
      const bool stops = lane.run->check_events(t, lane.z.data()) == model::Effect::stop;
      end(l, stops ? State::stopped : State::done);
    }
  }
}

}  // namespace bbsim::solve::sampled
