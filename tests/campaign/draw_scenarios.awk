# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Draws `count` scenarios from the keys and ranges of docs/reference/scenario.md into scenes/1.yaml and so on; every
# other one is then broken. Reads the names of the columns. `own`: the kinds of controllers of one's own that there
# are, "library" and "program". After draw.awk; scripts/try-scenarios runs it.

# Rows phi, theta: the gains that hold the ball, or whatever.
function gain(size, k) {
  if (chance(0.15)) return mixed(between(-size, size), 1)
  k = by_factors(size / 20, size)
  return chance(0.8) ? both(k) : mixed(k, 1)
}

function law(name, size, n, i, rows) {
  if (name == "pd") return "{kv: " gain(size) ", kp: " gain(size) "}"
  if (name == "pid") return "{kv: " gain(size) ", kp: " gain(size) ", ki: " gain(size / 4) "}"
  if (name == "lqr") {
    return "{position: " by_factors(0.1, 100) ", command: " by_factors(0.5, 100) \
      (chance(0.5) ? ", velocity: " by_factors(0.01, 10) : "") \
      (chance(0.3) ? ", angle: " between(0, 5) ", rate: " between(0, 1) : "") "}"
  }
  if (name == "state_feedback") {
    n = pick("4|8")
    rows = "[[" between(0, size) ", 0, " between(0, size) ", 0" (n == 8 ? ", 1, 0, 0.1, 0" : "")
    rows = rows "], [0, -" between(0, size) ", 0, -" between(0, size) (n == 8 ? ", 0, 1, 0, 0.1" : "") "]]"
    return "{gain: " rows "}"
  }
  if (name == "commands") return "{phi: " profile(0.1, 0) (chance(0.8) ? ", theta: " profile(0.1, 0) : "") "}"
  if (name == "program") {
    return "{command: [python3, pid.py], parameters: {kp: " between(0, size) ", kv: " between(0, size) ", ki: " \
      between(0, size / 4) "}}"
  }
  if (name == "library") {
    return "{file: libpid.so, parameters: {kp: " between(0, size) ", kv: " between(0, size) ", ki: " \
      between(0, size / 4) "}}"
  }
  return "{kv: " by_factors(0.5, 10) ", kp: " by_factors(0.5, 20) "}"
}

function fault() {
  return "{probability: " by_factors(1e-3, 0.3) ", duration: " seconds(by_factors(0.01, 0.5)) "}"
}
function stepper_keys() {
  loses = chance(0.3)
  rings = chance(0.3)
  return "stepper: {microsteps: " (chance(0.5) ? 16 : 1) ", gear: " by_factors(0.5, 20) \
    (loses ? ", torque: " by_factors(0.05, 2) ", inertia: " by_factors(1e-5, 1e-2) : "") \
    (loses && chance(0.5) ? ", corner_speed: " by_factors(1, 100) : "") \
    (rings ? ", natural_frequency: " by_factors(10, 1000) : "") \
    (rings && chance(0.5) ? ", damping: " between(0, 1.5) : "") "}, rate_limit: " \
    by_factors(0.5, 20) ", acceleration_limit: " by_factors(5, 500) \
    (!loses && !rings && chance(0.2) && !slides ? ", backlash: " radians(by_factors(1e-4, 0.01)) : "")
}
function servo_keys(words) {
  words = first_order ? "time_constant: " seconds(by_factors(0.01, 0.3)) \
                      : "natural_frequency: " by_factors(3, 200) ", damping: " between(0, 2)
  return words servo_limits()
}
function servo_limits(words) {
  if (chance(0.3) && !slides) words = words ", angle_limit: " radians(between(0.2, 0.6))
  if (chance(0.3)) words = words ", rate_limit: " by_factors(0.5, 20)
  if (chance(0.3) && !first_order) words = words ", acceleration_limit: " by_factors(5, 500)
  if (sampled && chance(0.3)) words = words ", dead_band: " radians(by_factors(1e-4, 0.01))
  if (chance(0.2) && !slides) words = words ", backlash: " radians(by_factors(1e-4, 0.01))
  return words
}

function rods() {
  return "{horn: " metres(between(0.015, 0.03)) ", arm: " metres(between(0.03, 0.08)) ", offset: [" \
    metres(between(0.03, 0.06)) ", " metres(between(0.03, 0.06)) "]" (chance(0.2) ? ", rod: " metres(0.045) : "") "}"
}
function link(linked, table) {
  table = "{table: {file: curve.csv, servo: alpha, plate: beta}}"
  if (linked == "rods") line("  linkage: " rods())
  if (linked == "curve") line("  linkage: " table)
  if (linked == "axes") {
    line("  linkage: {phi: " (chance(0.5) ? table : rods()) (chance(0.7) ? ", theta: " rods() : "") "}")
  }
  if (linked == "three") {
    line("  three_servos: {radius_base: " metres(between(0.05, 0.07)) ", radius_plate: " metres(between(0.07, 0.1)) \
         ", horn: " metres(between(0.03, 0.05)) ", rod: " metres(between(0.095, 0.12)) ", height: " \
         metres(between(0.09, 0.12)) "}")
  }
}

function motor(drives, name, j, kp, torque, words) {
  kp = j * by_factors(10, 1e4)
  torque = sprintf("%.6g", kp * by_factors(0.003, 1))
  if (chance(0.3)) words = words ", rotor_inertia: " sprintf("%.6g", j * by_factors(0.01, 1))
  if (chance(0.3)) words = words ", viscous: " by_factors(1e-4, 0.05)
  if (sticks) words = words ", friction: " sprintf("%.6g", torque * by_factors(0.01, 1))
  if (chance(0.5)) words = words ", torque_limit: " torque
  if (dc) {
    words = words ", dc: {resistance: " by_factors(0.5, 20) ", torque_constant: " by_factors(0.003, 0.1) \
      (chance(0.7) ? ", gear: " between(1, 50) : "") (chance(0.6) ? ", voltage_limit: " by_factors(0.5, 24) : "") "}"
  }
  if (drives == "angle") {
    words = words ", position_loop: {kp: " sprintf("%.6g", kp) \
      (chance(0.9) ? ", kd: " sprintf("%.6g", 2 * between(0, 1.5) * sqrt(kp * j)) : "") \
      (chance(0.6) && name != "lqr" ? ", ki: " sprintf("%.6g", kp * by_factors(0.1, 50)) : "") "}"
  }
  line("  motor: {" substr(words == "" ? ", viscous: 1e-3" : words, 3) "}")
}

function sampling(drives, period) {
  period = by_factors(0.002, 0.1)
  line("  sampling:")
  line("    period: " seconds(period))
  if (chance(0.4)) line("    delay: " seconds(by_factors(0.001, 0.1)))
  if (chance(0.3) && drives == "angle") line("    resolution: " radians(by_factors(1e-4, 0.01)))
  if (chance(0.4)) line("    derivative_filter: " seconds(by_factors(0.005, 0.1)))
  jitter = chance(0.2)
  if (jitter) {
    line("    jitter: " (chance(0.5) ? seconds(sprintf("%.6g", period * between(0, 0.5))) \
                                     : "{file: periods.csv, period: period}"))
  }
  if (played || !chance(0.6)) return
  line("  sensor:")
  line("    resolution: " metres(by_factors(1e-5, 0.005)))
  noise = chance(0.5)
  if (noise) line("    noise: " by_factors(1e-5, 0.002))
  if (noise || jitter) line("    seed: " int(rand() * 1000))
  if (chance(0.3)) line("    delay: " seconds(by_factors(0.001, 0.1)))
  if (chance(0.3)) line("    dropout: " between(0, 0.5))
  if (chance(0.15)) line("    stuck: " fault())
  if (chance(0.2)) line("    rotation: " radians(between(-0.3, 0.3)))
  if (chance(0.2)) line("    scale: " (chance(0.5) ? between(0.8, 1.2) : "[" between(0.8, 1.2) ", 1]"))
  if (chance(0.2)) line("    offset: " point(0.01))
  area = chance(0.3)
  if (area) line("    area: [0.3, " metres(between(0.05, 0.4)) "]")
  if (chance(0.15)) line("    dead_zones: [[-0.01, 0.005, " metres(between(0, 0.05)) ", 0.02]]")
  if (chance(0.2)) line("    on_miss: " (area && chance(0.5) ? "edge" : "last"))
  if (chance(0.3)) {
    period = chance(0.3) ? period * pick("0.5|1.5|2|3") : by_factors(0.003, 0.1)
    line("    period: " sprintf("%.6g", period))
    if (chance(0.3)) line("    burst: " fault())
    if (chance(0.5)) line("    phase: " sprintf("%.6g", period * between(0, 0.99)))
  }
}

# Whether the scene can fill a column.
function has(name) {
  if (name ~ /reference|tracking/) return closed && !played
  if (name ~ /_command/) return closed
  if (name ~ /measured/) return sampled
  if (name ~ /^motor_(torque|power)/) return inertia
  if (name ~ /_believed/) return steppers && (name ~ /^servo_/) == (linked == "three")
  if (name == "servo_third") return linked == "three"
  if (name ~ /^servo_/) return by == "angle"
  if (name ~ /^push_/) return pushes
  if (name ~ /^slip_|loss_power|energy_lost|motor_work/) return coupled
  if (name ~ /current|voltage|electrical/) return torques && dc
  if (name ~ /^(phi|theta)_torque/) return torques
  return 1
}

function draw(  name, drives, plate, end, i, columns, gravity, start, mounting, factor, inverts, rolling, viscous,
                pivoting, plate_mass, j, limit) {
  scene = ""
  end = by_factors(0.05, 4)
  by = pick("motion|motion|motion|torque|angle|angle|angle|angle|acceleration|motors|motors|motors")
  closed = by !~ /^(motion|torque)$/
  torques = by ~ /^(torque|motors)$/
  sampled = closed && chance(0.5)
  name = pick("pd|pid|state_feedback|lqr|gravity_compensation|feedback_linearisation|commands")
  if (sampled && own != "" && chance(0.12)) name = pick(own)
  drives = by == "motors" ? pick("angle|torque|voltage") : by
  if (closed && name ~ /gravity_compensation|commands/) drives = "angle"
  if (by == "acceleration" && drives == "angle") by = "angle"
  if (closed && name == "feedback_linearisation") {
    by = drives = "acceleration"
    sampled = torques = 0
  }
  played = closed && name == "commands"
  inverts = closed && name == "feedback_linearisation"
  gravity = !closed && chance(0.1) ? 0 : chance(0.5) ? by_factors(0.5, 25) : ""
  factor = chance(0.3) ? between(0, 0.67) : chance(0.05) ? 0 : ""
  rolling = !inverts && chance(0.25)
  viscous = chance(0.15)
  pivoting = !inverts && factor "" != "0" && chance(0.2)
  slides = !inverts && factor "" != "0" && chance(0.15)
  pushes = !inverts && chance(0.12)
  linked = by == "angle" ? pick("no|no|no|no|rods|curve|axes|three") : "no"
  if (name ~ /program|library/ && linked == "three") linked = "rods"
  coupled = torques || rolling || viscous || pivoting || slides || pushes || linked != "no"
  dc = torques && (drives == "voltage" || chance(0.4))
  sticks = torques && chance(0.3)
  first_order = sampled && by == "angle" && name != "lqr" && !slides && chance(0.2)

  if (chance(0.3)) line("title: " pick("drawn|\"a: b\"|'it''s'|Ball über Kante"))
  if (gravity != "") line("gravity: " gravity)
  line("ball:")
  line("  radius: " metres(by_factors(0.002, 0.2)))
  if (torques || viscous || pushes || chance(0.4)) line("  mass: " (torques ? by_factors(0.002, 0.5) : by_factors(0.001, 10)))
  if (chance(0.7)) line("  position: " point(0.15))
  if (chance(0.5)) line("  velocity: [" between(-0.5, 0.5) ", " between(-0.5, 0.5) "]")
  if (chance(0.3)) line("  spin: " between(-20, 20))
  if (factor != "") line("  inertia_factor: " factor)
  if (rolling || viscous || pivoting) {
    line("  losses: {" substr((rolling ? ", rolling: " by_factors(1e-5, 0.1) : "") \
                              (viscous ? ", viscous: " by_factors(1e-8, 1e-4) : "") \
                              (pivoting ? ", pivoting: " metres(by_factors(1e-6, 0.01)) : ""), 3) "}")
  }
  if (slides && chance(0.5)) line("  rotation: [" between(-50, 50) ", " between(-50, 50) "]")
  if (pushes) {
    line("  push: {" pick("x|y") ": " profile(0.3, 0) "}")
  }
  plate = chance(0.4) ? pick("size|diameter") : ""
  inertia = torques || chance(0.3)
  plate_mass = inertia && chance(0.3)
  if (plate != "" || inertia) line("plate:")
  if (plate == "size") line("  size: [" metres(between(0.05, 0.6)) ", " metres(between(0.05, 0.6)) "]")
  if (plate == "diameter") line("  diameter: " metres(between(0.05, 0.6)))
  j = by_factors(2e-4, 0.1)
  if (inertia) line("  inertia: [" j ", " by_factors(2e-4, 0.1) ", " by_factors(1e-4, 0.1) "]")
  if (plate_mass) line("  mass: " by_factors(0.01, 3))
  if (plate_mass && chance(0.7)) line("  centre_of_mass: " metres(between(-0.05, 0.05)))

  start = (closed || torques) && linked != "three" && chance(0.4)
  mounting = chance(0.25)
  if (by != "acceleration" || start || mounting) line("gimbal:")
  if (by == "motion") {
    line("  motion:")
    line("    phi: " profile(0.3, 1))
    if (chance(0.8)) line("    theta: " profile(0.3, 1))
  }
  if (by == "torque") {
    line("  torque:")
    line("    phi: " profile(0.05, 0))
    if (chance(0.8)) line("    theta: " profile(0.05, 0))
  }
  if (torques) motor(by == "torque" ? "torque" : drives, name, j)
  if (torques && chance(0.3)) line("  ring_inertia: " by_factors(1e-5, 0.01))
  if (start) {
    line("  start: {phi: " between(-0.05, 0.05) (first_order ? "" : ", theta_rate: " between(-0.1, 0.1)) "}")
  }
  steppers = by == "angle" && sampled && chance(0.2)
  if (by == "angle") {
    if (steppers) {
      line("  servo: {" stepper_keys() "}")
    } else {
      line("  servo: {" servo_keys() \
           (linked != "three" && chance(0.2) ? ", " pick("phi|theta") ": {" substr("x, x: 1" servo_limits(), 9) "}" : "") "}")
    }
    link(linked)
  }
  if (mounting) {
    line("  mounting: {height: " metres(between(-0.05, 0.05)) ", phi_offset: " between(-0.05, 0.05) ", skew: " \
         between(-0.2, 0.2) (chance(0.5) ? ", yaw: " between(-1, 1) ", base_tilt: " between(-0.05, 0.05) : "") "}")
  }
  if (closed) {
    line("controller:")
    line("  " name ": " law(name, drives == "torque" ? 0.5 : drives == "voltage" ? 20 : 2))
    line("  drives: " drives)
    if (name != "commands") line("  reference: " path(0.1))
    limit = drives == "voltage" ? by_factors(0.5, 24) : drives == "torque" ? by_factors(0.005, 0.5) : by_factors(0.05, 1.2)
    if (chance(0.4)) {
      line("  limit: " (chance(0.7) ? limit : "{" pick("phi|theta") ": " limit "}"))
    }
    if (linked != "no" && name !~ /program|library/ && chance(0.6)) line("  assumes: " pick("ratio|exact"))
    if (sampled) sampling(drives)
  }
  if (slides || chance(0.5)) {
    line("events:")
    line("  lift_off: " pick("stop|note"))
    if (plate != "") line("  edge: " pick("stop|note"))
    if (slides) {
      i = by_factors(0.02, 1)
      line("  slip: {friction: " i ", sliding_friction: " sprintf("%.6g", i * between(0, 0.999)) ", action: slide}")
    } else if (chance(0.5)) {
      line("  slip: {friction: " by_factors(0.02, 1) ", action: " pick("stop|note") "}")
    }
    if (chance(0.5)) line("  tilt: {limit: " radians(between(0.05, 1)) ", action: " pick("stop|note") "}")
    if (rolling && chance(0.5)) line("  rest: " pick("stop|note"))
    if (sticks && chance(0.5)) line("  stick: " pick("stop|note"))
    if (inverts && chance(0.5)) line("  singularity: {distance: " between(0.01, 0.5) ", action: " pick("stop|note") "}")
  }
  line("time:")
  line("  end: " seconds(end))
  line("  step: " sprintf("%.6g", end / by_factors(2, 300)))
  if (chance(0.6)) {
    line("solver:")
    line("  method: " pick("auto|radau|bdf|adams"))
    if (chance(0.2)) line("  error: " metres(by_factors(1e-8, 1e-3)))
    else {
      if (chance(0.6)) line("  rtol: " by_factors(1e-12, 1e-3))
      if (chance(0.6)) line("  atol: " by_factors(1e-13, 1e-4))
    }
  }
  if (chance(0.7)) {
    columns = "t"
    for (i = 1; i <= names; ++i) {
      if (column[i] != "t" && chance(0.3) && has(column[i])) columns = columns ", " column[i]
    }
    if (closed && name ~ /program|library/ && chance(0.5)) columns = columns ", x_integral"
    line("output:")
    line("  columns: [" columns "]")
  }
  if (chance(0.05)) line("sweep: {vary: {ball.radius: \"linear:0.005:0.02:4\"}, measure: [max_tilt]}")
}

# One place is made worse.
function worsen(  at, way, n, lines, i, other) {
  way = pick("value|value|value|value|value|character|character|lost|doubled|lost line|doubled line|cut|key" \
             "|indent")
  at = 1 + int(rand() * length(scene))
  if (way == "value" || way == "key") {  # of a line's last key, or somewhere within
    n = split(scene, lines, "\n") - 1
    i = 1 + int(rand() * n)
    if (way == "key") sub(/[a-z_]+:/, pick("raduis:|x:|position:|kv:|file:|? :|<<:|&a ball:"), lines[i])
    else {
      other = pick("nan|.nan|.inf|-.inf|-1|0|-0.0|1e308|1e-320|1e9|1e-9|1e400|+1|1.|.5|1e3|0x10|1_000|١" \
                   "|abc|\"\"|\"10 kg\"|\"1 m/s\"|\"3 furlongs\"|\"10  cm\"|null|~|true|yes" \
                   "|[1, 2]|[[1, 0], [0]]|[]|{}|{a: 1}|*a|!!str 1|'|\"|[[[[[[[[")
      gsub(/&/, "\\\\&", other)
      if (chance(0.4)) sub(/: .*$/, ": " other, lines[i])
      else sub(/[0-9][0-9.e-]*/, other, lines[i])
    }
    scene = ""
    for (i = 1; i <= n; ++i) line(lines[i])
  }
  if (way == "character") {
    other = pick("\t|:|: |{|}|[|]|,|#| #|\"|'|-|- |%|@|`|!|&|*|\n|\r|\\|é|\377|\001|\033[31m|0")
    scene = substr(scene, 1, at - 1) other substr(scene, at)
  }
  if (way == "lost") scene = substr(scene, 1, at - 1) substr(scene, at + 1 + int(rand() * 4))
  if (way == "doubled") scene = substr(scene, 1, at) substr(scene, at)
  if (way == "cut") scene = substr(scene, 1, at)
  if (way ~ /line|indent/) {
    n = split(scene, lines, "\n") - 1
    at = 1 + int(rand() * n)
    scene = ""
    for (i = 1; i <= n; ++i) {
      if (i == at && way == "lost line") continue
      if (i == at && way == "doubled line") line(lines[i])
      if (i == at && way == "indent") lines[i] = chance(0.5) ? "  " lines[i] : substr(lines[i], 3)
      line(lines[i])
    }
  }
}

{ column[++names] = $1 }

END {
  srand(seed)
  for (number = 1; number <= count; ++number) {
    draw()
    if (number % 2 == 0) for (times = 1 + int(rand() * 3); times > 0; --times) worsen()
    put(number)
  }
}
