function [cases, summary] = bbsim_sweep(scenario, vary, varargin)
%BBSIM_SWEEP  Simulate a scenario of bbsim at many values of its keys.
%   CASES = BBSIM_SWEEP(SCENARIO, VARY) returns one row per case: a table in MATLAB, a struct of columns
%   in Octave. SCENARIO is as for BBSIM_RUN. VARY is {KEY, VALUES, ...}; VALUES are numbers, a cell
%   array of values, or a text as `bbsim sweep --vary` takes it:
%
%       cases = bbsim_sweep('step.yaml', {'controller.pid.kp.0.0', 0.5:0.1:1}, ...
%                           'Measure', {'x.Overshoot'});
%       plot(cases.controller_pid_kp_0_0, cases.x_Overshoot)
%       cases = bbsim_sweep('step.yaml', {'ball.position.0', 'normal:0:2 mm'}, 'Samples', 1000);
%
%   The columns are the case, the varied keys, status, reason, end_time and the measures. In their
%   names, all characters but letters and digits become _.
%
%   [CASES, SUMMARY] = BBSIM_SWEEP(...) also returns the summary: the settings, and how cases ended.
%
%   BBSIM_SWEEP(SCENARIO, VARY, NAME, VALUE, ...) takes 'Set', 'Measure' and 'Error' as BBSIM_RUN
%   does, and
%     'Combine'  'grid', all combinations (default), or 'zip'
%     'Samples'  the number of cases to draw for uniform and normal
%     'Seed'     the seed of drawn values
%     'Threads'  the number of threads
%     'Output'   a file to keep, FILE.csv or FILE.h5; CASES is empty for FILE.h5
%     'Resume'   true to continue an unfinished sweep into Output
%
%   See also BBSIM_RUN, BBSIM_LINEARIZE, BBSIM_PROBLEMS.

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

options = bbsim_options(varargin, {'Set', 'Measure', 'Error', 'Combine', 'Samples', 'Seed', ...
                                   'Threads', 'Output', 'Resume'});
[folder, remove] = bbsim_folder(); %#ok<ASGLU> removes the folder when this function ends
output = fullfile(folder, 'cases.csv');
if ~isempty(options.Output), output = options.Output; end
summary_file = fullfile(folder, 'summary.json');
words = [{'-o', output, '--summary', summary_file}, bbsim_common(options), bbsim_vary(vary)];
for name = {'Combine', 'Samples', 'Seed', 'Threads'}
  value = options.(name{1});
  if ~isempty(value), words = [words, {['--' lower(name{1})], bbsim_plain(value)}]; end %#ok<AGROW>
end
if ~isempty(options.Resume) && options.Resume, words{end + 1} = '--resume'; end
bbsim_call(folder, 'sweep', scenario, words);
summary = jsondecode(fileread(summary_file));
[~, ~, ending] = fileparts(output);
cases = [];
if strcmpi(ending, '.csv'), cases = bbsim_table(output, false); end
end

function words = bbsim_vary(vary)
words = {};
if mod(numel(vary), 2) ~= 0
  error('bbsim:commandLine', 'bbsim_sweep: found %d values for VARY; allowed: {KEY, VALUES, ...}', ...
        numel(vary));
end
for i = 1:2:numel(vary)
  values = vary{i + 1};
  if isnumeric(values) || islogical(values), values = num2cell(values(:)'); end
  if iscell(values)
    values = ['list:' strjoin(cellfun(@bbsim_plain, values(:)', 'UniformOutput', false), ',')];
  end
  words = [words, {'--vary', [char(vary{i}) '=' char(values)]}]; %#ok<AGROW>
end
end
