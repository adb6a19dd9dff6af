function linear = bbsim_linearize(scenario, varargin)
%BBSIM_LINEARIZE  Linearize a scenario of bbsim.
%   LINEAR = BBSIM_LINEARIZE(SCENARIO) returns a struct: the matrices A, B, C and D, dt (the period,
%   s; 0 in continuous time), the names of states, inputs and outputs, poles and zeros (complex),
%   and, of a closed loop, margins. SCENARIO is as for BBSIM_RUN.
%
%       plant = bbsim_linearize('rig.yaml', 'Kind', 'plant');
%       K = place(plant.A, plant.B, poles);
%       model = ss(plant.A, plant.B, plant.C, plant.D, plant.dt);
%
%   BBSIM_LINEARIZE(SCENARIO, NAME, VALUE, ...) takes
%     'Kind'     'plant', 'loop' or 'sampled'; default: that of `bbsim linearize`
%     'At'       'home' (default), 'equilibrium', or a time of the run, such as 2 or '2 s'
%     'Set'      keys to set, {KEY, VALUE, ...}
%
%   See also BBSIM_RUN, BBSIM_SWEEP, BBSIM_PROBLEMS.

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

options = bbsim_options(varargin, {'Set', 'Kind', 'At'});
[folder, remove] = bbsim_folder(); %#ok<ASGLU> removes the folder when this function ends
file = fullfile(folder, 'linear.json');
words = [{'-o', file}, bbsim_common(options)];
if ~isempty(options.Kind)
  if ~any(strcmp(options.Kind, {'plant', 'loop', 'sampled'}))
    error('bbsim:commandLine', ...
          'bbsim_linearize: Kind: found %s; allowed: ''plant'', ''loop'' or ''sampled''', ...
          bbsim_plain(options.Kind));
  end
  words{end + 1} = ['--' options.Kind];
end
if ~isempty(options.At), words = [words, {'--at', bbsim_plain(options.At)}]; end
bbsim_call(folder, 'linearize', scenario, words);

linear = jsondecode(fileread(file));
for list = {'states', 'inputs', 'outputs'}
  linear.(list{1}) = cellstr(linear.(list{1}));
end
n = numel(linear.states);
m = numel(linear.inputs);
p = numel(linear.outputs);
% jsondecode makes a column of a matrix of one row.
linear.A = reshape(linear.A, n, n);
linear.B = reshape(linear.B, n, m);
linear.C = reshape(linear.C, p, n);
linear.D = reshape(linear.D, p, m);
for list = {'poles', 'zeros'}
  if isfield(linear, list{1})
    pairs = reshape(linear.(list{1}), [], 2);
    linear.(list{1}) = complex(pairs(:, 1), pairs(:, 2));
  end
end
linear.dt = 0;
if ~isempty(linear.period), linear.dt = linear.period; end
linear = rmfield(linear, 'period');
end
