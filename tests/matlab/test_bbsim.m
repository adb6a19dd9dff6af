% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

% Tests of the functions in matlab/, for Octave and MATLAB. The environment variable BBSIM names the
% program, SOURCE the sources.
function test_bbsim()
source = getenv('SOURCE');
addpath(fullfile(source, 'matlab'));
folder = tempname();
mkdir(folder);
cd(folder);
tests = {@runs_a_struct, @runs_a_file, @keeps_all_bits, @keeps_a_file, @sets_keys, @measures, ...
         @says_what_is_wrong, @says_what_options_are_wrong, @finds_no_program, @ends_early, @sweeps, ...
         @draws, @goes_on, @linearizes, @linearizes_one_state_a_row, @closes_the_loop};
failed = 0;
for i = 1:numel(tests)
  name = regexprep(func2str(tests{i}), '^@', '');
  try
    tests{i}(source);
    fprintf('passed: %s\n', name);
  catch fault
    failed = failed + 1;
    fprintf('FAILED: %s: %s\n', name, fault.message);
    for place = fault.stack(:)', fprintf('  %s:%d\n', place.name, place.line); end
  end
end
cd(source);
if exist('OCTAVE_VERSION', 'builtin'), confirm_recursive_rmdir(false, 'local'); end
rmdir(folder, 's');
if failed > 0, error('test_bbsim: %d of %d failed', failed, numel(tests)); end
end

function s = scene()
s.ball = struct('radius', '2 cm', 'position', [0.05 0]);
s.gimbal.motion = struct('phi', 0, 'theta', '1 deg');
s.time = struct('end', 1, 'step', 0.1);
end

function fault = fault_of(action)
fault = [];
try
  action();
catch fault
  return
end
error('there was no error');
end

function check(holds, varargin)
if ~all(holds(:)), error(['does not hold: ' varargin{1}], varargin{2:end}); end
end

function runs_a_struct(~)
[rows, summary] = bbsim_run(scene());
check(numel(rows.t) == 11, '11 rows');
check(abs(rows.x - 0.05) < 1e-4, 'x hardly moves');
check(abs(rows.y(end)) > 0.01, 'y moves');
check(strcmp(summary.status, 'done'), 'done');
s = scene();
s.output.columns = {'t', 'vy'};
s.title = sprintf('"a" \\ b\n%sc', char(9));
[rows, summary] = bbsim_run(s);
check(isequal(fieldnames(rows), {'t'; 'vy'}), 'two columns');
check(strcmp(summary.title, s.title), 'the title is %s', summary.title);
s.output.columns = {'t'};
check(isequal(fieldnames(bbsim_run(s)), {'t'}), 'one column');
end

function runs_a_file(source)
rows = bbsim_run(fullfile(source, 'configs', 'fig2a.yaml'));
check(numel(rows.t) == 1001, '1001 rows, not %d', numel(rows.t));
copyfile(fullfile(source, 'configs', 'fig2a.yaml'), 'it''s a b.yaml');
again = bbsim_run('it''s a b.yaml');
check(isequal(rows, again), 'the same rows');
end

function keeps_all_bits(~)
s = scene();
s.ball.position = [1 / 3 / 10, nextafter_of(0.1)];
rows = bbsim_run(s);
check(rows.x(1) == s.ball.position(1), 'the bits of x');
check(rows.y(1) == s.ball.position(2), 'the bits of y');
end

function value = nextafter_of(value)
value = value + eps(value);
end

function keeps_a_file(~)
rows = bbsim_run(scene(), 'Output', 'kept.csv');
check(exist('kept.csv', 'file') == 2, 'kept.csv');
check(numel(rows.t) == 11, '11 rows');
check(isempty(bbsim_run(scene(), 'Output', 'kept.h5')), 'no rows');
check(exist('kept.h5', 'file') == 2, 'kept.h5');
end

function sets_keys(source)
file = fullfile(source, 'configs', 'fig2b.yaml');
rows = bbsim_run(file, 'Set', {'ball.position', [0.01 0.02], 'time.end', '1 s', 'title', 'a: b'});
check(rows.x(1) == 0.01 && rows.y(1) == 0.02, 'the start');
check(rows.t(end) == 1, 'the end');
gains = bbsim_run(file, 'Set', {'controller.pd.kv', [2 0; 0 -2]});
whole = bbsim_run(file, 'Set', {'controller.pd.kv', {{2, 0}, {0, -2}}});
check(isequal(gains, whole), 'a matrix is a list of its rows');
end

function measures(source)
[~, summary] = bbsim_run(fullfile(source, 'configs', 'step.yaml'), ...
                         'Measure', {'x.RiseTime', 'rms_x from 5 s'});
check(summary.measures.x_RiseTime > 0, 'the rise time');
check(numel(fieldnames(summary.measures)) == 2, 'two measures');
end

function says_what_is_wrong(~)
s = scene();
s.ball.positon = [0 0];
s.ball.mass = -1;
fault = fault_of(@() bbsim_run(s));
check(strcmp(fault.identifier, 'bbsim:scenario'), 'its identifier is %s', fault.identifier);
problems = bbsim_problems(fault);
check(numel(problems) == 2, 'two problems, not %d', numel(problems));
found = {problems.key};
check(ismember('ball.mass', found) && ismember('ball.positon', found), 'the keys');
mass = problems(strcmp(found, 'ball.mass'));
check(strcmp(mass.message, 'found -1'), 'what was found: %s', mass.message);
check(strcmp(mass.hint, 'a mass greater than 0, such as 0.1 or "100 g"'), 'the hint: %s', mass.hint);
name = problems(strcmp(found, 'ball.positon'));
check(strcmp(name.hint, 'did you mean ball.position?'), 'the hint: %s', name.hint);
check(isempty(name.where), 'a struct has no lines');

file = fopen('wrong.yaml', 'w');
fprintf(file, 'ball: {radius: -1}\ntime: {end: 1}\n');
fclose(file);
problems = bbsim_problems(fault_of(@() bbsim_run('wrong.yaml')));
check(any(strcmp({problems.where}, 'wrong.yaml:1:16')), 'the places: %s', strjoin({problems.where}));
problems = bbsim_problems(fault_of(@() bbsim_run(scene(), 'Set', {'ball.radius', -1})));
check(strcmp(problems(1).key, 'ball.radius'), 'the key: %s', problems(1).key);
check(~isempty(strfind(problems(1).where, '--set')), 'the place: %s', problems(1).where); %#ok<STREMP>

s = scene();
s.ball.mass = NaN;
fault = fault_of(@() bbsim_run(s));
check(~isempty(strfind(fault.message, 'ball.mass: found a number that is not finite')), ...
      'the message: %s', fault.message); %#ok<STREMP>
s.ball.mass = @sin;
fault = fault_of(@() bbsim_run(s));
check(~isempty(strfind(fault.message, 'ball.mass: found a value of class')), ...
      'the message: %s', fault.message); %#ok<STREMP>
end

function says_what_options_are_wrong(~)
for action = {@() bbsim_run(scene(), 'Sett', {}), @() bbsim_run(scene(), 'Set'), ...
              @() bbsim_run(scene(), 'Set', {'a'}), @() bbsim_sweep(scene(), {'ball.radius'}), ...
              @() bbsim_linearize(scene(), 'Kind', 'plan')}
  fault = fault_of(action{1});
  check(strcmp(fault.identifier, 'bbsim:commandLine'), 'its identifier is %s', fault.identifier);
end
fault = fault_of(@() bbsim_run(3));
check(strcmp(fault.identifier, 'bbsim:scenario'), 'its identifier is %s', fault.identifier);
end

function finds_no_program(~)
program = getenv('BBSIM');
restore = onCleanup(@() setenv('BBSIM', program));
setenv('BBSIM', '/nowhere/bbsim');
fault = fault_of(@() bbsim_run(scene()));
check(strcmp(fault.identifier, 'bbsim:program'), 'its identifier is %s', fault.identifier);
check(~isempty(strfind(fault.message, 'environment variable BBSIM')), 'the hint'); %#ok<STREMP>
end

function ends_early(~)
s = scene();
s.plate.size = {'20 cm', '20 cm'};
s.events.edge = 'stop';
s.time.end = 10;
lastwarn('', '');
[rows, summary] = bbsim_run(s);
[~, identifier] = lastwarn();
check(rows.t(end) < 10, 'it ends early');
check(strcmp(summary.reason_code, 'event'), 'the reason');
check(strcmp(identifier, 'bbsim:endedEarly'), 'the warning is %s', identifier);
end

function sweeps(~)
cases = bbsim_sweep(scene(), {'ball.position.0', [0, 0.01, 1 / 30]});
check(cases.ball_position_0 == [0; 0.01; 1 / 30], 'the values');
check(strcmp(cases.status, 'done'), 'the statuses');
check(abs(cases.end_x - cases.ball_position_0) < 1e-4, 'x hardly moves');
[cases, summary] = bbsim_sweep(scene(), {'gravity', {9.8, '981 cm/s^2'}, 'ball.radius', 'list:1 cm,2 cm'}, ...
                               'Combine', 'zip', 'Measure', 'end_y', 'Threads', 1);
check(numel(cases.case) == 2 && summary.cases == 2, 'two cases');
check(numel(fieldnames(cases)) == 7, 'seven columns');
check(isempty(bbsim_sweep(scene(), {'gravity', 9:11}, 'Output', 's.h5')), 'no cases');
end

function draws(~)
first = bbsim_sweep(scene(), {'ball.position.0', 'normal:0:2 mm'}, 'Samples', 20, 'Seed', 3);
second = bbsim_sweep(scene(), {'ball.position.0', 'normal:0:2 mm'}, 'Samples', 20, 'Seed', 3);
check(isequal(first, second) && numel(first.case) == 20, 'the same draws');
end

function goes_on(~)
vary = {'gravity', 9:0.5:11};
bbsim_sweep(scene(), vary, 'Output', 'part.csv');
cases = bbsim_sweep(scene(), vary, 'Output', 'part.csv', 'Resume', true);
check(numel(cases.case) == 5, 'five cases');
end

function linearizes(source)
linear = bbsim_linearize(fullfile(source, 'configs', 'step.yaml'), 'Kind', 'plant');
check(isequal(size(linear.A), [8 8]) && isequal(size(linear.B), [8 2]), 'A and B');
check(isequal(size(linear.C), [2 8]) && isequal(size(linear.D), [2 2]), 'C and D');
check(linear.dt == 0, 'continuous time');
check(strcmp(linear.states{3}, 'vx'), 'the states');
check(max(abs(sort(real(eig(linear.A))) - sort(real(linear.poles)))) < 1e-6, 'the poles');
sampled = bbsim_linearize(fullfile(source, 'configs', 'step.yaml'), 'Kind', 'sampled');
check(sampled.dt == 0.02, 'the period');
end

function linearizes_one_state_a_row(~)
s = scene();
s.ball.position = [0 0.01];
linear = bbsim_linearize(s);
check(isequal(size(linear.A), [4 4]) && isequal(size(linear.B), [4 1]), 'A and B');
check(isequal(size(linear.C), [1 4]) && isequal(size(linear.D), [1 1]), 'C and D');
at = bbsim_linearize(s, 'At', 0.5);
check(~strcmp(at.at, linear.at), 'the point');
end

% The gain of a design holds the ball where the linear system says.
function closes_the_loop(source)
s = rig();
plant = bbsim_linearize(s, 'Kind', 'plant');
K = feedback_gain(plant.A, plant.B);
if isempty(K), fprintf('  (not designed: there is no place)\n'), return, end
s.controller = struct('state_feedback', struct('gain', K), 'drives', 'angle', ...
                      'reference', struct('point', [0.03 0]));
rows = bbsim_run(s);
check(abs(rows.x(end) - 0.03) < 1e-4, 'the ball is at 3 cm, not %g m', rows.x(end));
closed = bbsim_linearize(s, 'Kind', 'loop');
designed = eig(plant.A - plant.B * K);
check(max(abs(sort(real(closed.poles)) - sort(real(designed)))) < 1e-4, 'the poles');
end

function s = rig()
s.ball = struct('radius', '2 cm', 'position', [-0.03 0]);
s.gimbal.servo = struct('natural_frequency', '5 Hz', 'damping', 0.8);
s.controller = struct('state_feedback', struct('gain', zeros(2, 8)), 'drives', 'angle', ...
                      'reference', struct('point', [0.03 0]));
s.time = struct('end', 6, 'step', 0.02);
end

function K = feedback_gain(A, B)
K = [];
if exist('OCTAVE_VERSION', 'builtin')
  try, pkg('load', 'control'); catch, end %#ok<NOCOM>
end
if ~exist('place', 'file'), return, end
K = place(A, B, [-3 -3.1 -4 -4.1 -25 + 15i, -25 - 15i, -26 + 15i, -26 - 15i]);
end
