# Draws `count` scenarios from the keys and ranges of docs/reference/scenario.md into scenes/1.yaml and so on; every
# other one is then broken. Reads the names of the columns. scripts/try-scenarios runs it.

function between(a, b) { return sprintf("%.6g", a + (b - a) * rand()) }
function by_factors(a, b) { return sprintf("%.6g", exp(log(a) + (log(b) - log(a)) * rand())) }
function chance(p) { return rand() < p }
function pick(list, parts) { return parts[1 + int(rand() * split(list, parts, "|"))] }
function either_sign(x) { return chance(0.5) ? x : -x }
function line(words) { scene = scene words "\n" }

# The same quantity with a unit now and then.
function metres(x) { return chance(0.3) ? sprintf("\"%.6g cm\"", 100 * x) : x }
function seconds(x) { return chance(0.3) ? sprintf("\"%.6g ms\"", 1000 * x) : x }
function radians(x) { return chance(0.3) ? sprintf("\"%.6g deg\"", 57.29577951308232 * x) : x }

function point(size) { return "[" metres(between(-size, size)) ", " metres(between(-size, size)) "]" }

function profile(depth, kind) {
  kind = depth < 1 && chance(0.2) ? "sum" : pick("constant|sinusoid|sinusoid|ramp|table")
  if (kind == "constant") return radians(between(-0.2, 0.2))
  if (kind == "sinusoid") {
    return "{sinusoid: {amplitude: " between(-0.3, 0.3) ", frequency: " by_factors(0.01, 50) \
      (chance(0.5) ? ", phase: " radians(between(-7, 7)) : "") \
      (chance(0.3) ? ", offset: " between(-0.1, 0.1) : "") "}}"
  }
  if (kind == "ramp") return "{ramp: {start: " between(-0.1, 0.1) ", rate: " between(-0.1, 0.1) "}}"
  if (kind == "table") return "{table: {file: table.csv, time: t, value: phi}}"
  return "[" profile(depth + 1) ", " profile(depth + 1) "]"
}

function path(kind, n, i, t, points, times) {
  kind = pick("point|circle|lissajous|waypoints|table")
  if (kind == "point") return "{point: " point(0.1) "}"
  if (kind == "circle") {
    return "{circle: {radius: " metres(between(0, 0.1)) ", rate: " between(-3, 3) \
      (chance(0.3) ? ", phase: " between(-4, 4) : "") (chance(0.3) ? ", centre: " point(0.05) : "") "}}"
  }
  if (kind == "lissajous") {
    return "{lissajous: {amplitude: " point(0.1) ", rate: [" between(-3, 3) ", " between(-3, 3) "]" \
      (chance(0.3) ? ", phase: [" between(-4, 4) ", 1]" : "") "}}"
  }
  if (kind == "table") return "{table: {file: table.csv, time: t, x: x, y: y}}"
  n = 2 + int(rand() * 5)
  for (i = 0; i < n; ++i) {
    t += by_factors(0.05, 1)
    points = points (i ? ", " : "") point(0.1)
    times = times (i ? ", " : "") t
  }
  return "{waypoints: {points: [" points "], times: [" times "]" \
    (chance(0.4) ? ", rest: " pick("true|false") : "") "}}"
}

# Rows phi, theta: the gains that hold the ball, or whatever.
function gain(size, k) {
  if (chance(0.15)) return between(-size, size)
  k = by_factors(size / 20, size)
  if (chance(0.8)) return "[[" k ", 0], [0, -" k "]]"
  return "[[" k ", " between(-k, k) "], [" between(-k, k) ", -" k "]]"
}

function law(name, n, i, rows) {
  if (name == "pd") return "{kv: " gain(2) ", kp: " gain(2) "}"
  if (name == "pid") return "{kv: " gain(2) ", kp: " gain(2) ", ki: " gain(0.5) "}"
  if (name == "lqr") {
    return "{position: " by_factors(0.1, 100) ", command: " by_factors(0.5, 100) \
      (chance(0.5) ? ", velocity: " by_factors(0.01, 10) : "") \
      (chance(0.3) ? ", angle: " between(0, 5) ", rate: " between(0, 1) : "") "}"
  }
  if (name == "state_feedback") {
    n = pick("4|8")
    rows = "[[" between(0, 2) ", 0, " between(0, 2) ", 0" (n == 8 ? ", 1, 0, 0.1, 0" : "")
    rows = rows "], [0, -" between(0, 2) ", 0, -" between(0, 2) (n == 8 ? ", 0, 1, 0, 0.1" : "") "]]"
    return "{gain: " rows "}"
  }
  return "{kv: " by_factors(0.5, 10) ", kp: " by_factors(0.5, 20) "}"
}

function draw(  closed, sampled, name, drives, first_order, servo, plate, motors, end, i, columns, gravity,
                start, mounting) {
  scene = ""
  end = by_factors(0.05, 4)
  closed = chance(0.65)
  sampled = closed && chance(0.5)
  name = pick("pd|pid|state_feedback|lqr|gravity_compensation|feedback_linearisation")
  if (name == "feedback_linearisation") sampled = 0
  drives = name == "gravity_compensation" || chance(0.75) ? "angle" : "acceleration"
  if (name == "feedback_linearisation") drives = "acceleration"
  gravity = !closed && chance(0.1) ? 0 : chance(0.5) ? by_factors(0.5, 25) : ""

  if (chance(0.3)) line("title: " pick("drawn|\"a: b\"|'it''s'|Ball über Kante"))
  if (gravity != "") line("gravity: " gravity)
  line("ball:")
  line("  radius: " metres(by_factors(0.002, 0.2)))
  if (chance(0.4)) line("  mass: " by_factors(0.001, 10))
  if (chance(0.7)) line("  position: " point(0.15))
  if (chance(0.5)) line("  velocity: [" between(-0.5, 0.5) ", " between(-0.5, 0.5) "]")
  if (chance(0.3)) line("  spin: " between(-20, 20))
  if (chance(0.3)) line("  inertia_factor: " between(0, 0.67))
  plate = chance(0.4) ? pick("size|diameter") : ""
  motors = chance(0.3)
  if (plate != "" || motors) line("plate:")
  if (plate == "size") line("  size: [" metres(between(0.05, 0.6)) ", " metres(between(0.05, 0.6)) "]")
  if (plate == "diameter") line("  diameter: " metres(between(0.05, 0.6)))
  if (motors) line("  inertia: [" by_factors(1e-4, 0.1) ", " by_factors(1e-4, 0.1) ", " by_factors(1e-4, 0.1) "]")

  first_order = sampled && drives == "angle" && name != "lqr" && chance(0.2)
  start = closed && chance(0.4)
  mounting = chance(0.25)
  if (!closed || drives == "angle" || start || mounting) {
    line("gimbal:")
    if (!closed) {
      line("  motion:")
      line("    phi: " profile(0))
      if (chance(0.8)) line("    theta: " profile(0))
    } else {
      if (start) {
        line("  start: {phi: " between(-0.05, 0.05) (first_order ? "" : ", theta_rate: " between(-0.1, 0.1)) "}")
      }
      if (drives == "angle") {
        servo = first_order ? "time_constant: " seconds(by_factors(0.01, 0.3)) \
                            : "natural_frequency: " by_factors(3, 200) ", damping: " between(0, 2)
        if (chance(0.3)) servo = servo ", angle_limit: " radians(between(0.2, 0.6))
        if (chance(0.3)) servo = servo ", rate_limit: " by_factors(0.5, 20)
        if (chance(0.3) && !first_order) servo = servo ", acceleration_limit: " by_factors(5, 500)
        if (sampled && chance(0.3)) servo = servo ", dead_band: " radians(by_factors(1e-4, 0.01))
        if (chance(0.2)) servo = servo ", backlash: " radians(by_factors(1e-4, 0.01))
        line("  servo: {" servo "}")
      }
    }
    if (mounting) {
      line("  mounting: {height: " metres(between(-0.05, 0.05)) ", phi_offset: " between(-0.05, 0.05) ", skew: " \
           between(-0.2, 0.2) (chance(0.5) ? ", yaw: " between(-1, 1) ", base_tilt: " between(-0.05, 0.05) : "") "}")
    }
  }
  if (closed) {
    line("controller:")
    line("  " name ": " law(name))
    line("  drives: " drives)
    line("  reference: " path())
    if (chance(0.4)) line("  limit: " by_factors(0.05, 1.2))
    if (sampled) {
      line("  sampling:")
      line("    period: " seconds(by_factors(0.002, 0.1)))
      if (chance(0.4)) line("    delay: " seconds(by_factors(0.001, 0.1)))
      if (chance(0.3) && drives == "angle") line("    resolution: " radians(by_factors(1e-4, 0.01)))
      if (chance(0.4)) line("    derivative_filter: " seconds(by_factors(0.005, 0.1)))
      if (chance(0.6)) {
        line("  sensor:")
        line("    resolution: " metres(by_factors(1e-5, 0.005)))
        if (chance(0.5)) {
          line("    noise: " by_factors(1e-5, 0.002))
          line("    seed: " int(rand() * 1000))
        }
        if (chance(0.3)) line("    delay: " seconds(by_factors(0.001, 0.1)))
        if (chance(0.3)) line("    dropout: " between(0, 0.5))
        if (chance(0.3)) line("    area: [0.3, " metres(between(0.05, 0.4)) "]")
      }
    }
  }
  if (chance(0.4)) {
    line("events:")
    line("  lift_off: " pick("stop|note"))
    if (plate != "") line("  edge: " pick("stop|note"))
    if (chance(0.5)) line("  slip: {friction: " by_factors(0.02, 1) ", action: " pick("stop|note") "}")
    if (chance(0.5)) line("  tilt: {limit: " radians(between(0.05, 1)) ", action: " pick("stop|note") "}")
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
      if (column[i] == "t" || chance(0.7)) continue
      if (column[i] ~ /reference|tracking|command/ && !closed) continue
      if (column[i] ~ /measured/ && !sampled) continue
      if (column[i] ~ /motor/ && !motors) continue
      columns = columns ", " column[i]
    }
    line("output:")
    line("  columns: [" columns "]")
  }
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
    file = "scenes/" number ".yaml"
    printf "%s", scene > file
    close(file)
  }
}
