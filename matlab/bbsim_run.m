function [rows, summary] = bbsim_run(scenario, varargin)
%BBSIM_RUN  Simulate a scenario of bbsim.
%   ROWS = BBSIM_RUN(SCENARIO) runs a scenario and returns its output columns: a table in MATLAB, a
%   struct of columns in Octave. ROWS.x is a column of either. SCENARIO is a struct with the keys of
%   a scenario, or the name of a YAML file:
%
%       s.ball = struct('radius', '2 cm', 'position', [0.05 0]);
%       s.gimbal.motion = struct('phi', 0, 'theta', '1 deg');
%       s.time = struct('end', 1, 'step', 0.01);
%       rows = bbsim_run(s);
%       plot(rows.t, rows.y)
%
%   A matrix becomes a list of its rows, a cell array a list, [] becomes null, and a containers.Map a
%   mapping, whose keys need not be names of fields. Files that a struct names are relative to the
%   current folder.
%
%   [ROWS, SUMMARY] = BBSIM_RUN(...) also returns the summary of the run: how it ended, the model,
%   statistics and measures. A measure x.RiseTime is SUMMARY.measures.x_RiseTime.
%
%   BBSIM_RUN(SCENARIO, NAME, VALUE, ...) takes
%     'Set'      keys to set, {KEY, VALUE, ...}, such as {'ball.radius', 0.02}
%     'Measure'  measures to take: 'max_tilt', or {'x.RiseTime', 'rms_x from 5 s'}
%     'Error'    a bound for the error of x and y: 1e-9 (m) or '1 um'
%     'Output'   a file to keep, FILE.csv or FILE.h5; ROWS is empty for FILE.h5
%
%   A run that ends early returns its rows so far, with the warning bbsim:endedEarly. A faulty
%   scenario is an error bbsim:scenario; BBSIM_PROBLEMS returns its keys and hints.
%
%   The program is the one that the environment variable BBSIM names, or bbsim in the PATH.
%
%   See also BBSIM_SWEEP, BBSIM_LINEARIZE, BBSIM_PROBLEMS.

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

options = bbsim_options(varargin, {'Set', 'Measure', 'Error', 'Output'});
[folder, remove] = bbsim_folder(); %#ok<ASGLU> removes the folder when this function ends
output = fullfile(folder, 'rows.csv');
if ~isempty(options.Output), output = options.Output; end
summary_file = fullfile(folder, 'summary.json');
words = [{'-o', output, '--summary', summary_file}, bbsim_common(options)];
code = bbsim_call(folder, 'run', scenario, words);
summary = jsondecode(fileread(summary_file));
if code ~= 0
  warning('bbsim:endedEarly', '%s', ['bbsim: ' summary.reason]);
end
[~, ~, ending] = fileparts(output);
rows = [];
if strcmpi(ending, '.csv') && exist(output, 'file')
  rows = bbsim_table(output, true);
end
end
