# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# What both kinds of drawn scenarios are made of: numbers, quantities, profiles and paths. A file that draws
# scenes (draw_*.awk) comes after it, appends lines to `scene`, and calls put().

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

# Rows phi and theta, whose signs differ: of two axes alike, of two that are not, and of two that act on each other.
function both(k) { return "[[" k ", 0], [0, " (-k) "]]" }
function each(k, share) { return "[[" k ", 0], [0, " sprintf("%.6g", -k * (1 + between(-share, share))) "]]" }
function mixed(k, share) {
  return "[[" k ", " sprintf("%.6g", k * between(-share, share)) "], [" sprintf("%.6g", k * between(-share, share)) \
    ", " sprintf("%.6g", -k * (1 + between(-share, share))) "]]"
}

# `size` in the profile's unit; units are drawn for angles alone.
function profile(size, is_angle, depth, kind) {
  kind = depth < 1 && chance(0.2) ? "sum" : pick("constant|sinusoid|sinusoid|ramp" (is_angle ? "|table" : ""))
  if (kind == "constant") return is_angle ? radians(between(-0.7 * size, 0.7 * size)) : between(-size, size)
  if (kind == "sinusoid") {
    return "{sinusoid: {amplitude: " between(-size, size) ", frequency: " by_factors(0.01, 50) \
      (chance(0.5) ? ", phase: " radians(between(-7, 7)) : "") \
      (chance(0.3) ? ", offset: " between(-size / 3, size / 3) : "") "}}"
  }
  if (kind == "ramp") return "{ramp: {start: " between(-size / 3, size / 3) ", rate: " between(-size / 3, size / 3) "}}"
  if (kind == "table") return "{table: {file: table.csv, time: t, value: phi}}"
  return "[" profile(size, is_angle, depth + 1) ", " profile(size, is_angle, depth + 1) "]"
}

# Within `size` of the origin, m.
function path(size, kind, n, i, t, points, times) {
  kind = pick("point|circle|lissajous|waypoints|table|step|square|staircase")
  if (kind == "point") return "{point: " point(size) "}"
  if (kind == "circle") {
    return "{circle: {radius: " metres(between(0, size)) ", rate: " between(-3, 3) \
      (chance(0.3) ? ", phase: " between(-4, 4) : "") (chance(0.3) ? ", centre: " point(size / 2) : "") "}}"
  }
  if (kind == "lissajous") {
    return "{lissajous: {amplitude: " point(size) ", rate: [" between(-3, 3) ", " between(-3, 3) "]" \
      (chance(0.3) ? ", phase: [" between(-4, 4) ", 1]" : "") "}}"
  }
  if (kind == "table") return "{table: {file: table.csv, time: t, x: x, y: y}}"
  if (kind == "step") return "{step: {from: " point(size) ", to: " point(size) ", at: " by_factors(0.05, 3) "}}"
  if (kind == "square") {
    return "{square: {amplitude: " point(size / 2) ", period: " by_factors(0.1, 5) \
      (chance(0.5) ? ", phase: [" between(-4, 4) ", 1]" : "") \
      (chance(0.3) ? ", duty: " between(0.1, 0.9) : "") "}}"
  }
  n = 2 + int(rand() * 5)
  for (i = 0; i < n; ++i) {
    t += by_factors(0.05, 1)
    points = points (i ? ", " : "") point(size)
    times = times (i ? ", " : "") t
  }
  return "{" kind ": {points: [" points "], times: [" times "]" \
    (kind == "waypoints" && chance(0.4) ? ", rest: " pick("true|false") : "") "}}"
}

function put(number, file) {
  file = "scenes/" number ".yaml"
  printf "%s", scene > file
  close(file)
}
