// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/keys.hpp"

#include <algorithm>
#include <sstream>

#include "scenario/sections.hpp"

namespace bbsim::scenario {
namespace {

constexpr KeyText top_level[] = {
    {"title", "any text, for reports and pictures"},
    {"gravity", "acceleration of gravity"},
    {"ball", "[ball](#ball)"},
    {"plate", "[plate](#plate)"},
    {"gimbal", "what moves the plate: [gimbal](#gimbal)"},
    {"controller", "a closed loop: [controller](#controller)"},
    {.keys = "events", .meaning = "what bbsim watches for: [events](#events)", .standard = "none"},
    {"time", "[time, solver and output](#time-solver-and-output)"},
    {"solver output", "the same section"},
    {.keys = "sweep", .meaning = "defaults of `bbsim sweep`: [sweep](#sweep)", .standard = "none"},
    {"exercise", "tasks for a learner: [exercise](#exercise)"},
};

constexpr KeyText ball[] = {
    {"ball.radius", "radius"},
    {"ball.mass",
     "mass; changes forces, torques and energy, and the motion only where noted below"},
    {"ball.position", "contact point (x, y) at t = 0"},
    {"ball.velocity", "its velocity in the plate frame, (x', y')"},
    {"ball.spin", "rate of turn about the plate's normal, γ'"},
    {"ball.inertia_factor",
     "moment of inertia over m r²: 0 for all mass at the center, 2/5 for a solid ball, 2/3 for a "
     "thin shell"},
    {.keys = "ball.rolling_radius",
     .meaning = "of a ball in a groove or between rails: distance from its center to the axis "
                "through its two contacts; only in scenarios along one axis",
     .range = "> 0, ≤ `ball.radius`"},
    {.keys = "ball.rotation",
     .meaning = "$[\\omega_x, \\omega_y]$ at t = 0, relative to the plate, about its x and y axes",
     .standard = "from rolling"},
    {"ball.push.x .y",
     "[profiles](#profiles): a force on the ball's center, along the plate's axes"},
    {"ball.losses.rolling", "coefficient of rolling resistance"},
    {.keys = "ball.losses.viscous",
     .meaning = "couple divided by the rate of turn about an axis in the plate",
     .unit = "N m s"},
    {"ball.losses.pivoting", "couple about the normal, divided by the normal force"},
};

constexpr KeyText plate[] = {
    {"plate.size", "[a, b], sides along x and y of a rectangle about the plate's origin"},
    {"plate.diameter", "diameter of a disc about the plate's origin, instead of `size`"},
    {.keys = "plate.inertia",
     .meaning =
         "$[J_x, J_y, J_n]$ about the gimbal's center, along the plate's x axis, y axis and normal",
     .unit = "kg m²"},
    {"plate.mass", "mass of the plate"},
    {"plate.center_of_mass",
     "height of its center of mass above the gimbal's center, along the normal; negative below"},
};

constexpr KeyText gimbal[] = {
    {.keys = "gimbal.motion.phi .theta",
     .meaning = "[profiles](#profiles): a prescribed motion",
     .standard = "0"},
    {.keys = "gimbal.torque.phi .theta",
     .meaning = "[profiles](#profiles): torques of the motors",
     .standard = "0"},
    {"gimbal.start.phi .theta",
     "angles at t = 0 under a controller or torques, without the mounting's offsets"},
    {"gimbal.start.phi_rate .theta_rate", "rates at t = 0"},
    {.keys = "gimbal.servo",
     .meaning = "[servos](#servos): required under `drives: legs`, and under `drives: angle` "
                "without `gimbal.motor`, "
                "otherwise refused",
     .standard = "-"},
    {"gimbal.motor", "[torques and motors](#torques-and-motors)"},
    {.keys = "gimbal.ring_inertia",
     .meaning = "inertia, about phi's axis, of the parts that turn with phi alone; only where "
                "torques move the gimbal",
     .unit = "kg m²"},
    {"gimbal.linkage", "[linkages](#linkages) between servos and plate"},
    {"gimbal.three_servos", "[three servos](#three-servos) under the plate"},
    {"gimbal.mounting", "[mounting](#mounting) errors"},
};

constexpr KeyText mounting[] = {
    {"mounting.height", "height of the contact plane above the gimbal's center; negative below"},
    {"mounting.phi_offset .theta_offset",
     "angle of the plate where the servo, or the prescribed motion, is at zero"},
    {"mounting.skew",
     "deviation of the angle between theta's and phi's axes from 90 degrees, about the normal"},
    {"mounting.yaw", "angle of the plate's x axis from theta's unskewed axis, about the normal"},
    {"mounting.base_tilt", "tilt of the whole gimbal about the base's x axis"},
};

constexpr KeyText servos[] = {
    {"servo.model", "values for all keys below; a key that is given replaces its value"},
    {.keys = "servo.natural_frequency",
     .meaning = "$\\omega_n$ of a second-order servo",
     .standard = "required without `time_constant`, `stepper` and `model`"},
    {.keys = "servo.damping",
     .meaning = "$\\zeta$ of a second-order servo",
     .standard = "required without `time_constant`, `stepper` and `model`"},
    {"servo.time_constant", "T of a first-order servo, instead of the two keys above"},
    {"servo.stepper.model",
     "values for `steps`, `torque` and `inertia`; a key that is given "
     "replaces its value"},
    {.keys = "servo.stepper.steps .microsteps",
     .meaning = "full steps in a turn of a [stepper motor](#stepper-motors), and microsteps in a "
                "step; instead of the keys above",
     .standard = "200, 16"},
    {"servo.stepper.gear", "turns of the motor in a turn of its shaft behind the gear"},
    {.keys = "servo.stepper.torque",
     .meaning =
         "greatest torque of the motor, beyond which it [loses steps](#stepper-motors); with "
         "`inertia`; a plain number",
     .unit = "N m",
     .standard = "never loses any"},
    {.keys = "servo.stepper.inertia",
     .meaning =
         "moment of inertia that the motor turns: its rotor's, and the plate's share divided "
         "by gear²; a plain number",
     .unit = "kg m²",
     .standard = "required with `torque`"},
    {"servo.stepper.corner_speed", "speed of the motor beyond which its torque falls as 1/speed"},
    {.keys = "servo.stepper.natural_frequency",
     .meaning = "of the [swings](#stepper-motors) of the shaft about the driver's angle",
     .standard = "no swings"},
    {"servo.stepper.damping", "damping ratio of these swings"},
    {"servo.angle_limit", "hard stops at ± this angle"},
    {"servo.rate_limit", "largest rate"},
    {"servo.speed", "the same, as data sheets give it: `\"0.17 s/60deg\"`"},
    {.keys = "servo.acceleration_limit",
     .meaning = "largest acceleration; a plain number",
     .unit = "rad/s²"},
    {"servo.dead_band",
     "smaller changes of the command have no effect; also as a width of the pulse: `\"4 us\"`"},
    {.keys = "servo.scale",
     .meaning = "angle per microsecond of the pulse, for such a `dead_band`",
     .standard = "180°/1856"},
    {.keys = "servo.backlash",
     .meaning = "full width of the gap between servo and plate",
     .range = "0, or ≥ 1e-6"},
    {"servo.phi .theta", "any of the keys above, for one axis"},
};

constexpr KeyText linkages[] = {
    {"linkage.horn .arm", "length of the bar on the servo, and of the bar on the plate"},
    {"linkage.offset",
     "$[d_x, d_z]$, the gimbal's axis from the servo's; both bars lie along +x at home. The rod is "
     "upright there if $d_x$ is horn − arm"},
    {.keys = "linkage.rod",
     .meaning = "length of the push rod; the default is the length that fits at home. With another "
                "length, the plate is tilted when the servo is at zero",
     .standard = "closes at home"},
    {"linkage.table.file", "a measured curve instead of rods: a CSV or HDF5 file"},
    {.keys = "linkage.table.servo .plate",
     .meaning = "its columns: the servo's angle and the plate's",
     .unit = "rad"},
    {"linkage.table.header", "names of the columns of a CSV without a header"},
    {.keys = "linkage.table.unit", .meaning = "unit of both columns", .standard = "rad"},
    {"linkage.phi .theta", "rods or a curve for one axis; an axis that you leave out is ideal"},
    {.keys = "controller.assumes",
     .meaning = "how a law converts an angle of the plate into a servo angle; or the keys of "
                "[three servos](#three-servos), the legs that the firmware assumes",
     .standard = "`ratio`; `exact` with `three_servos`",
     .range = "`exact`, `ratio`"},
};

constexpr KeyText three_servos[] = {
    {.keys = "three_servos.radius_base",
     .meaning = "radius of the servos' axes",
     .standard = "required, or in each leg"},
    {.keys = "three_servos.radius_plate",
     .meaning = "radius of the joints under the plate",
     .standard = "required, or in each leg"},
    {.keys = "three_servos.horn .rod",
     .meaning = "lengths of horn and rod",
     .standard = "required, or in each leg"},
    {.keys = "three_servos.height",
     .meaning = "height of the joints above the servos' axes where the plate is level",
     .standard = "required, or in each leg"},
    {"three_servos.legs", "a list of three mappings, for legs that differ"},
    {.keys = "three_servos.legs.angle",
     .meaning = "azimuth of the leg's plane, from the plate's x axis towards y",
     .standard = "0, 2π/3, 4π/3"},
    {"three_servos.legs.radius", "both radii of the leg"},
    {.keys = "three_servos.legs.radius_base .radius_plate .horn .rod .height",
     .meaning = "as above, of the leg",
     .standard = "as for all legs"},
    {"three_servos.legs.joint_height",
     "height of the joint in the plate, from any level that all three share"},
    {"three_servos.legs.offset", "angle of the horn from home where the servo is at zero"},
    {.keys = "three_servos.legs.direction",
     .meaning = "-1: the horn falls as the servo's angle grows",
     .range = "1, -1"},
    {"three_servos.legs.servo",
     "[servo](#servos) of the leg: its keys replace those of `gimbal.servo`"},
};

constexpr KeyText torques_and_motors[] = {
    {.keys = "motor.rotor_inertia",
     .meaning = "inertia of each rotor, seen through its gear",
     .unit = "kg m²"},
    {.keys = "motor.viscous",
     .meaning = "friction torque divided by the axis' rate",
     .unit = "N m s"},
    {.keys = "motor.friction",
     .meaning = "dry friction; up to this torque it holds an axis at rest"},
    {.keys = "motor.torque_limit", .meaning = "largest torque"},
    {.keys = "motor.dc.resistance", .meaning = "resistance of the armature", .unit = "Ω"},
    {.keys = "motor.dc.torque_constant",
     .meaning = "torque constant of the armature",
     .unit = "N m/A"},
    {"motor.dc.gear", "turns of the motor per turn of the axis"},
    {.keys = "motor.dc.voltage_limit", .meaning = "largest voltage", .unit = "V"},
    {.keys = "motor.position_loop.kp", .meaning = "proportional gain", .unit = "N m/rad"},
    {.keys = "motor.position_loop.kd", .meaning = "rate gain", .unit = "N m s/rad"},
    {.keys = "motor.position_loop.ki", .meaning = "integral gain", .unit = "N m/(rad s)"},
};

constexpr KeyText controller[] = {
    {.keys =
         "controller.pd .pid .state_feedback .lqr .gravity_compensation .feedback_linearization",
     .meaning = "one of the built-in [laws](#laws)",
     .standard = "-"},
    {.keys = "controller.program .library",
     .meaning = "a controller of your own: [controllers.md](controllers.md#keys)",
     .standard = "-"},
    {.keys = "controller.commands.phi .theta",
     .meaning = "[profiles](#profiles): commands that are known beforehand, whatever the ball does",
     .standard = "0"},
    {"controller.drives", "what the commands are"},
    {.keys = "controller.reference",
     .meaning = "where the ball should be: [reference paths](#reference-paths)",
     .standard = "required, except with `commands`"},
    {.keys = "controller.limit",
     .meaning =
         "each command saturates at ± this: a number, or {phi: ..., theta: ...} with one or both",
     .unit = "of the command"},
    {.keys = "controller.limit.phi .theta",
     .meaning = "the same for one axis",
     .unit = "of the command"},
    {.keys = "controller.assumes", .meaning = "[linkages](#linkages)", .standard = "-"},
    {"controller.sampling",
     "a discrete-time controller: [sampling](#sampling); without it the law is continuous"},
    {"controller.sensor",
     "what a sampled controller measures: [sensor](#sensor); without it, the exact position"},
};

constexpr KeyText laws[] = {
    {.keys = "pd.kv .kp",
     .meaning =
         "2x2; rows phi, theta; columns x, y: [[k, 0], [0, -k]] (*Signs*, below). A number k "
         "stands for [[k, 0], [0, k]]; under `drives: angle`, only 0 is allowed",
     .unit = "below"},
    {.keys = "pid.kv .kp .ki", .meaning = "the same", .unit = "below"},
    {.keys = "state_feedback.gain",
     .meaning = "K: rows phi, theta, each of 4 numbers (x, y, vx, vy) or 8 (phi, theta and their "
                "rates too)",
     .unit = "below"},
    {.keys = "lqr.position", .meaning = "weight of x² and y²", .unit = "1/m²"},
    {.keys = "lqr.velocity", .meaning = "weight of vx² and vy²", .unit = "1/(m/s)²"},
    {.keys = "lqr.angle", .meaning = "weight of the servos' angles²", .unit = "1/rad²"},
    {.keys = "lqr.rate", .meaning = "weight of their rates²", .unit = "1/(rad/s)²"},
    {.keys = "lqr.command",
     .meaning = "weight of $u_\\phi^2$ and $u_\\theta^2$",
     .unit = "1/command²"},
    {.keys = "gravity_compensation.kv .kp",
     .meaning = "a number or 2x2; rows x, y; columns x, y",
     .unit = "1/s, 1/s²"},
    {.keys = "feedback_linearization.kv .kp", .meaning = "the same", .unit = "1/s, 1/s²"},
};

constexpr KeyText reference_paths[] = {
    {.keys = "point", .meaning = "[x, y], a point at rest", .standard = "-"},
    {"circle.radius", "R"},
    {"circle.rate", "ω; $x = c_x + R \\cos(\\omega t + p)$, $y = c_y + R \\sin(\\omega t + p)$"},
    {"circle.phase", "p"},
    {"circle.center", "$(c_x, c_y)$"},
    {"lissajous.amplitude", "[a, b]"},
    {"lissajous.rate",
     "$[\\omega_1, \\omega_2]$; $x = c_x + a \\cos(\\omega_1 t + p_1)$, $y = c_y + b "
     "\\sin(\\omega_2 t + p_2)$"},
    {"lissajous.phase", "$[p_1, p_2]$"},
    {"lissajous.center", "$(c_x, c_y)$"},
    {.keys = "waypoints.points", .meaning = "points (x, y)", .range = "2 to 10,000"},
    {.keys = "waypoints.times",
     .meaning = "the time at each point, one for each",
     .range = "increasing"},
    {.keys = "waypoints.rest",
     .meaning = "true: at rest at each point, with least jerk between; false: a C2 spline through "
                "the points",
     .unit = "-"},
    {"step.from", "the point before the step"},
    {"step.to", "the point from the step on"},
    {"step.at", "the time of the step"},
    {"square.amplitude", "[a, b]: from the center to either side"},
    {"square.period", "T"},
    {"square.phase",
     "$[p_1, p_2]$; $x = c_x + a$ where $2\\pi t/T + p_1$ is in the first `duty` of a turn, and "
     "$c_x - a$ in the rest; y likewise"},
    {"square.center", "$(c_x, c_y)$"},
    {"square.duty", "the part of a period at + a"},
    {.keys = "staircase.points", .meaning = "points (x, y)", .range = "2 to 10,000"},
    {.keys = "staircase.times",
     .meaning = "the time from which each point holds, one for each",
     .range = "increasing"},
    {"table.file .time .x .y", "a file and its columns: [tables from files](#tables-from-files)"},
    {"table.header", "names of the columns of a CSV without a header"},
    {.keys = "table.unit .time_unit",
     .meaning = "units of x and y, and of the times",
     .standard = "m, s"},
    {.keys = "table.scale .offset",
     .meaning = "value = offset + scale × table; the offset in the table's own unit; a list of two "
                "gives x and y their own",
     .unit = "-",
     .standard = "1, 0"},
    {"table.delay", "value(t) = table(t − delay)"},
    {.keys = "table.time_offset",
     .meaning = "added to the table's times; `start`: its first row is t = 0",
     .standard = "0",
     .range = "a time, `start`"},
};

constexpr KeyText sampling[] = {
    {"sampling.period", "a sample at t = 0 and every period after"},
    {.keys = "sampling.delay",
     .meaning = "from a sample to its command; may exceed a period",
     .range = "0 to 100 periods"},
    {"sampling.resolution", "the command is rounded to the nearest multiple; 0 does not round"},
    {"sampling.derivative_filter", "time constant of the filter of velocities"},
    {"sampling.jitter", "standard deviation of a period"},
    {.keys = "sampling.jitter.file .period",
     .meaning = "instead of a number: a table of measured periods, and its column; after the last "
                "period it starts again",
     .standard = "-"},
    {"sampling.jitter.header", "names of the columns of a CSV without a header"},
    {.keys = "sampling.jitter.unit .time_unit",
     .meaning = "unit of these periods",
     .standard = "s"},
};

constexpr KeyText sensor[] = {
    {"sensor.resolution",
     "each coordinate, noise included, is [rounded](#sampling) to the nearest multiple; 0 does not "
     "round"},
    {"sensor.noise", "standard deviation of each coordinate: normal, drawn at each sample"},
    {"sensor.seed",
     "seed of noise, dropouts, faults and jitter; gives the same numbers on every machine"},
    {.keys = "sensor.delay",
     .meaning = "from the measurement to the sample; before t = 0 the ball is where it starts",
     .range = "0 to 100 periods"},
    {"sensor.dropout", "probability that a sample sees nothing"},
    {"sensor.stuck.probability", "probability that the sensor sticks at a reading"},
    {"sensor.stuck.duration", "time for which it then repeats this reading"},
    {"sensor.burst.probability", "probability that a frame waits, and others after it"},
    {"sensor.burst.duration", "time for which the first one waits; all then arrive together"},
    {"sensor.rotation", "rotation of the measured position"},
    {"sensor.scale", "factor on the measured position, or [x, y]"},
    {"sensor.offset", "offset of the measured position"},
    {"sensor.period", "period of the sensor's own frames"},
    {.keys = "sensor.phase", .meaning = "time of the first frame", .range = "≥ 0, < `period`"},
    {"sensor.area",
     "[a, b], sides along x and y of the rectangle about the origin in which it sees the ball"},
    {"sensor.dead_zones",
     "rectangles in which it does not: a list of corners [x0, y0, x1, y1] with x0 < x1, y0 < y1"},
    {.keys = "sensor.contact_force",
     .meaning = "least normal force that a touch screen reads; needs `ball.mass`"},
    {"sensor.on_miss",
     "what a sample that sees nothing reads: `none`; `last`: the last reading again; `edge`: the "
     "corner of `area` at its least x and y, as screens that nobody touches"},
};

constexpr KeyText events[] = {
    {"events.edge", "the contact point leaves the plate"},
    {"events.lift_off", "the normal force is no longer positive"},
    {"events.slip.friction",
     "coefficient of static friction: the friction force exceeds it times the normal force"},
    {"events.slip.action", "`slide`: the ball slides: [losses and sliding](#losses-and-sliding)"},
    {.keys = "events.slip.sliding_friction",
     .meaning = "coefficient of sliding friction",
     .standard = "required with `slide`",
     .range = "0 to `friction`"},
    {"events.rest", "rolling resistance brings the ball to rest, or holds it at the start"},
    {"events.steps_lost", "a stepper with `torque` loses steps; noted, unless this is `stop`"},
    {"events.stick",
     "dry friction of its motor holds an axis; recorded as `stick_phi` or `stick_theta`"},
    {"events.tilt.limit", "the angle between the plate's normal and the vertical exceeds it"},
    {"events.tilt.action", ""},
    {"events.singularity.distance", "the column `singularity_distance` falls below it"},
    {"events.singularity.action", ""},
};

constexpr KeyText time_solver_and_output[] = {
    {"time.end", "end of the run"},
    {.keys = "time.step",
     .meaning = "a row at i × step, exactly, and at the end",
     .range = "> 0, `end` / 10⁹ or more"},
    {"solver.method",
     "`radau`: bbsim's own collocation; `bdf`, `adams`: CVODES; `auto` takes the cheapest, which "
     "is `radau`"},
    {"solver.rtol", "local relative tolerance"},
    {.keys = "solver.atol", .meaning = "local absolute tolerance", .unit = "state's unit"},
    {"solver.error", "instead of tolerances: a bound on the error of x and y at all output times"},
    {"output.columns", "[columns](columns.md) of the result, each once"},
};

constexpr KeyText sweep[] = {
    {"sweep.vary",
     "from keys to [value specifications](commands.md#values-of-a-sweep), such as `ball.radius: "
     "linear:0.005:0.02:16`"},
    {"sweep.combine", "`grid`: every combination; `zip`: first values together, then second ones"},
    {"sweep.samples", "cases to draw where values are drawn"},
    {"sweep.seed", "seed of drawn values"},
    {.keys = "sweep.measure",
     .meaning = "[measures](measures.md) to keep, such as `max_tilt`, `x.RiseTime`",
     .standard = "the [default measures](measures.md#default-measures-of-a-sweep)"},
};

constexpr KeyText exercise[] = {
    {"exercise.tasks", "a list of mappings, one for each task"},
    {"exercise.tasks.text", "what the learner should reach"},
    {"exercise.tasks.expect",
     "the bound that decides it, as in `run --expect`: `max_distance < 3 mm`"},
    {"exercise.free", "keys that the learner may change: each a number, or one of several names"},
};

constexpr KeyText profiles[] = {
    {.keys = "sinusoid.amplitude",
     .meaning = "A in offset + A sin(ωt + p)",
     .unit = "of the quantity"},
    {"sinusoid.frequency", "ω"},
    {"sinusoid.phase", "p"},
    {.keys = "sinusoid.offset", .meaning = "offset", .unit = "of the quantity"},
    {.keys = "ramp.start", .meaning = "value at t = 0", .unit = "of the quantity"},
    {.keys = "ramp.rate", .meaning = "rate", .unit = "of the quantity, per s"},
    {"pulse.start", "when it begins"},
    {"pulse.duration", "duration of rise and fall together"},
    {.keys = "pulse.value", .meaning = "value in its middle", .unit = "of the quantity"},
    {"table.file .time .value", "a file and its columns: [tables from files](#tables-from-files)"},
    {"table.header", "names of the columns of a CSV without a header: `[t, x, y]`"},
    {.keys = "table.unit .time_unit",
     .meaning = "units of the values and of the times",
     .standard = "SI"},
    {.keys = "table.scale .offset",
     .meaning = "value = offset + scale × table; the offset in the table's own unit",
     .unit = "-",
     .standard = "1, 0"},
    {"table.delay", "value(t) = table(t − delay)"},
    {.keys = "table.time_offset",
     .meaning = "added to the table's times; `start`: its first row is t = 0",
     .standard = "0",
     .range = "a time, `start`"},
};

constexpr KeyText own_controller[] = {
    {.keys = "controller.program.command",
     .meaning = "the program and its arguments; no shell reads them",
     .range = "1 to 1000 words"},
    {"controller.program.parameters",
     "names and numbers that bbsim passes to the program: `{kp: 0.7}`"},
    {"controller.program.timeout", "for each answer"},
    {.keys = "controller.program.start_timeout",
     .meaning = "for the first answer, which includes the program's startup",
     .standard = "5, at least `timeout`"},
    {"controller.library.file", "the shared library, relative to the scenario"},
    {"controller.library.parameters", "names and numbers that bbsim passes to the library"},
    {"controller.library.wiring",
     "for a sketch: the [wiring](wiring.md) of its board, relative to the scenario"},
    {.keys = "controller.library.serial.command .parameters .timeout .start_timeout",
     .meaning = "[a program at the sketch's `Serial`](#a-program-and-a-sketch); as of "
                "`controller.program`",
     .standard = "-"},
    {.keys = "controller.library.serial.period",
     .meaning = "time between samples of that program, such as its camera's frames",
     .standard = "`sampling.period`",
     .range = "≥ `sampling.period`"},
    {"controller.library.serial.delay",
     "time from a sample to the first byte that the program sends, such as its computation"},
};

constexpr KeyTable tables[] = {
    {"scenario.md", "Top level", "", top_level},
    {"scenario.md", "Ball", "", ball},
    {"scenario.md", "Plate", "", plate},
    {"scenario.md", "Gimbal", "", gimbal},
    {"scenario.md", "Mounting", "gimbal.", mounting},
    {"scenario.md", "Servos", "gimbal.", servos},
    {"scenario.md", "Linkages", "gimbal.", linkages},
    {"scenario.md", "Three servos", "gimbal.", three_servos},
    {"scenario.md", "Torques and motors", "gimbal.", torques_and_motors},
    {"scenario.md", "Controller", "", controller},
    {"scenario.md", "Laws", "controller.", laws},
    {"scenario.md", "Reference paths", "controller.reference.", reference_paths},
    {"scenario.md", "Sampling", "controller.", sampling},
    {"scenario.md", "Sensor", "controller.", sensor},
    {"scenario.md", "Events", "", events},
    {"scenario.md", "Time, solver and output", "", time_solver_and_output},
    {"scenario.md", "Sweep", "", sweep},
    {"scenario.md", "Exercise", "", exercise},
    {"scenario.md", "Profiles", "profile.", profiles},
    {"controllers.md", "Keys", "", own_controller},
};

struct Alias {
  std::string_view path, as;
};
constexpr Alias aliases[] = {
    {"ball.push.x", "profile"},
    {"ball.push.y", "profile"},
    {"gimbal.motion.phi", "profile"},
    {"gimbal.motion.theta", "profile"},
    {"controller.commands.phi", "profile"},
    {"controller.commands.theta", "profile"},
    {"gimbal.torque.phi", "profile"},
    {"gimbal.torque.theta", "profile"},
    {"controller.assumes", "gimbal.three_servos"},
    {"gimbal.three_servos.legs.servo", "gimbal.servo"},
    {"gimbal.servo.phi", "gimbal.servo"},
    {"gimbal.servo.theta", "gimbal.servo"},
    {"gimbal.linkage.phi", "gimbal.linkage"},
    {"gimbal.linkage.theta", "gimbal.linkage"},
};

}  // namespace

std::vector<std::string> KeyText::paths(std::string_view prefix) const {
  std::vector<std::string> paths;
  std::istringstream names{std::string(keys)};
  for (std::string name; names >> name;) {
    if (name.starts_with('.')) {
      name = paths.back().substr(0, paths.back().rfind('.')) + name;
    } else {
      const auto& top = declared_keys().keys;
      const std::string first = name.substr(0, name.find('.'));
      if (std::ranges::find(top, first, &yaml::DeclaredKey::name) == top.end()) {
        name.insert(0, prefix);
      }
    }
    paths.push_back(name);
  }
  return paths;
}

std::span<const KeyTable> key_tables() {
  return tables;
}

const yaml::Declared& declared_keys() {
  static const yaml::Declared declared = yaml::MappingOf(read_sections).declared();
  return declared;
}

std::string path_in_tables(std::string_view path) {
  for (const Alias& alias : aliases) {
    if (path.starts_with(alias.path) && path.substr(alias.path.size()).starts_with('.')) {
      return std::string(alias.as) + std::string(path.substr(alias.path.size()));
    }
  }
  return std::string(path);
}

const KeyText* text_of_key(std::string_view path) {
  for (const KeyTable& table : tables) {
    for (const KeyText& row : table.rows) {
      if (std::ranges::count(row.paths(table.prefix), path) > 0) return &row;
    }
  }
  return nullptr;
}

}  // namespace bbsim::scenario
