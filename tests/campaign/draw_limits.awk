# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Draws `count` scenarios in which integrals wait at limits, such as people might build, into scenes/1.yaml and so on:
# continuous PIDs with `limit`, and motors' position loops with `ki` at limits of their torque and voltage. After
# draw.awk; scripts/try-limits runs it.

# Another kind of matrix each time, of about `k`.
function gains(k, kind) {
  kind = pick("both|both|each|mixed")
  return kind == "both" ? both(k) : kind == "each" ? each(k, 0.5) : mixed(k, 0.5)
}

function limit(size, kind) {
  kind = pick("one|one|one|each|phi|theta")
  if (kind == "one") return size
  if (kind == "each") return "{phi: " size ", theta: " sprintf("%.6g", size * between(0.3, 3)) "}"
  return "{" kind ": " size "}"
}

function ball(mass) {
  line("ball:")
  line("  radius: " by_factors(0.005, 0.05))
  if (mass) line("  mass: " by_factors(0.005, 0.3))
  line("  position: " point(0.12))
  if (chance(0.7)) line("  velocity: [" between(-0.3, 0.3) ", " between(-0.3, 0.3) "]")
  if (chance(0.2)) line("  spin: " between(-10, 10))
}

# Plants are unstable now and then: what runs away is stopped before it is nonsense.
# bdf and adams begin anew, at their lowest order, at each sample: some hundred steps for each at tight tolerances.
function rest(slides, sampled, end) {
  line("events:")
  line("  tilt: {limit: 1.2, action: stop}")
  if (slides) {
    line("  slip: {friction: 0.3, sliding_friction: " between(0.1, 0.3) ", action: slide}")
    line("  lift_off: stop")
  }
  end = by_factors(0.5, 8)
  line("time: {end: " end ", step: " sprintf("%.6g", end / by_factors(10, 300)) "}")
  if (chance(0.3)) line("solver: {method: " (sampled ? "radau" : pick("radau|bdf|adams")) ", rtol: " by_factors(1e-11, 1e-5) "}")
}

function mounting() {
  if (!chance(0.15)) return
  line("  mounting: {height: " between(-0.03, 0.03) ", phi_offset: " between(-0.03, 0.03) ", skew: " \
       between(-0.1, 0.1) "}")
}

# A loop of second order and an integral: a bandwidth w (1/s) for the ball, of which 7 m/s^2 act on each rad.
function pid_by_servos(  w, horn) {
  w = by_factors(0.7, 4)
  ball(0)
  line("gimbal:")
  line("  servo: {natural_frequency: " by_factors(5, 80) ", damping: " between(0.4, 1.3) \
       (chance(0.25) ? ", rate_limit: " by_factors(0.3, 10) : "") \
       (chance(0.2) ? ", angle_limit: " by_factors(0.05, 0.5) : "") \
       (chance(0.15) ? ", acceleration_limit: " by_factors(5, 300) : "") \
       (chance(0.1) ? ", backlash: " by_factors(1e-4, 0.01) : "") "}")
  linked = pick("no|no|no|no|no|rods|rods|curve|three")
  if (linked == "rods") {
    line("  linkage: {horn: 0.024, arm: " between(0.03, 0.08) ", offset: [" between(0.03, 0.06) ", " \
         between(0.03, 0.06) "]}")
  }
  if (linked == "curve") line("  linkage: {table: {file: curve.csv, servo: alpha, plate: beta}}")
  if (linked == "three") {
    line("  three_servos: {radius_base: 0.06, radius_plate: 0.09, horn: 0.04, rod: 0.1, height: 0.11}")
  }
  mounting()
  line("controller:")
  line("  pid:")
  line("    kv: " gains(sprintf("%.6g", 2 * between(0.4, 1.2) * w / 7)))
  line("    kp: " gains(sprintf("%.6g", w * w / 7)))
  line("    ki: " gains(sprintf("%.6g", w ^ 3 / 7 * by_factors(0.02, 1.5))))
  line("  drives: angle")
  line("  limit: " limit(by_factors(0.005, 0.15)))
  if (linked != "no") line("  assumes: " pick("ratio|exact"))
  line("  reference: " path(0.08))
  rest(0, 0)
}

function pid_by_accelerations() {
  ball(0)
  line("gimbal:")
  line("  start: {phi: " between(-0.02, 0.02) ", theta: " between(-0.02, 0.02) "}")
  mounting()
  line("controller:")
  line("  pid:")
  line("    kv: " gains(by_factors(1, 100)))
  line("    kp: " gains(by_factors(1, 100)))
  line("    ki: " gains(by_factors(0.1, 100)))
  line("  drives: acceleration")
  line("  limit: " limit(by_factors(0.05, 5)))
  line("  reference: " path(0.05))
  rest(0, 0)
}

function outer_law(  w, name) {
  w = by_factors(0.7, 4)
  name = pick("pd|pd|pid|state_feedback|gravity_compensation")
  line("  " name ":")
  if (name == "gravity_compensation") {
    line("    {kv: " sprintf("%.6g", 1.6 * w) ", kp: " sprintf("%.6g", w * w) "}")
  } else if (name == "state_feedback") {
    line(sprintf("    {gain: [[%.6g, 0, %.6g, 0], [0, %.6g, 0, %.6g]]}", w * w / 7, 1.6 * w / 7, -w * w / 7, -1.6 * w / 7))
  } else {
    line("    kv: " gains(sprintf("%.6g", 1.6 * w / 7)))
    line("    kp: " gains(sprintf("%.6g", w * w / 7)))
    if (name == "pid") line("    ki: " gains(sprintf("%.6g", w ^ 3 / 7 * by_factors(0.02, 1))))
  }
}

# Gains for a bandwidth w of the plate's axes, whose inertia is j.
function position_loop(  j, w, kp, torque, sampled, slides, losses, dc) {
  j = by_factors(5e-4, 2e-2)
  w = by_factors(10, 60)
  kp = j * w * w
  torque = kp * by_factors(0.01, 0.5)
  sampled = chance(0.4)
  losses = chance(0.3)
  slides = chance(0.15)
  dc = chance(0.5)
  ball(1)
  if (losses) {
    line("  losses: {rolling: " by_factors(1e-4, 0.02) (chance(0.4) ? ", viscous: " by_factors(1e-7, 1e-5) : "") \
         (chance(0.4) ? ", pivoting: " by_factors(1e-5, 1e-3) : "") "}")
  }
  line("plate: {inertia: [" sprintf("%.6g, %.6g, %.6g", j, j * between(0.6, 1.2), j * between(1.2, 1.6)) "]" \
       (chance(0.3) ? ", mass: " by_factors(0.05, 1) ", centre_of_mass: " between(-0.02, 0.02) : "") "}")
  line("gimbal:")
  line("  motor:")
  line("    position_loop: {kp: " sprintf("%.6g", kp) ", kd: " sprintf("%.6g", 2 * between(0.2, 1.2) * w * j) ", ki: " \
       sprintf("%.6g", kp * w * by_factors(0.01, 1)) "}")
  if (!dc || chance(0.5)) line("    torque_limit: " sprintf("%.6g", torque))
  if (dc) {
    line("    dc: {resistance: 2, torque_constant: 0.02, gear: 10, voltage_limit: " \
         sprintf("%.6g", torque * by_factors(0.5, 4) * 10) "}")
  }
  if (chance(0.4)) line("    friction: " sprintf("%.6g", torque * by_factors(0.01, 0.5)))
  if (chance(0.3)) line("    viscous: " by_factors(1e-4, 1e-2))
  if (chance(0.3)) line("    rotor_inertia: " sprintf("%.6g", j * by_factors(0.01, 1)))
  if (chance(0.6)) {
    line("  start: {phi: " between(-0.15, 0.15) ", theta: " between(-0.15, 0.15) \
         (chance(0.5) ? ", theta_rate: " between(-1.5, 1.5) : "") "}")
  }
  mounting()
  line("controller:")
  outer_law()
  line("  drives: angle")
  if (chance(0.4)) line("  limit: " limit(by_factors(0.01, 0.2)))
  line("  reference: " path(0.08))
  if (sampled) {
    line("  sampling: {period: " by_factors(0.004, 0.06) (chance(0.3) ? ", delay: " by_factors(0.001, 0.05) : "") \
         (chance(0.3) ? ", derivative_filter: " by_factors(0.005, 0.05) : "") "}")
  }
  rest(slides, sampled)
}

function draw(  kind) {
  scene = ""
  kind = pick("servos|servos|accelerations|motors|motors")
  line("title: " kind)
  if (kind == "servos") pid_by_servos()
  else if (kind == "accelerations") pid_by_accelerations()
  else position_loop()
}

END {
  srand(seed)
  for (number = 1; number <= count; ++number) {
    draw()
    put(number)
  }
}
