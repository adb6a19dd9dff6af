% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

% Runs the code of docs/tutorials/matlab.md, block by block, and looks for what its text says.
function test_tutorial()
source = getenv('SOURCE');
addpath(fullfile(source, 'matlab'));
if exist('OCTAVE_VERSION', 'builtin')
  try, pkg('load', 'control'); catch, end %#ok<NOCOM>
end
if ~exist('dlqr', 'file'), fprintf('skipped: there is no dlqr\n'), return, end
set(0, 'DefaultFigureVisible', 'off');
text = fileread(fullfile(source, 'docs', 'tutorials', 'matlab.md'));
% Octave without a font cannot draw; the values are there all the same.
try
  plot(1, 1);
catch
  text = regexprep(text, '\nplot\([^\n]*', '');
end
blocks = regexp(text, '```matlab\n(.*?)\n```', 'tokens');
said = '';
for i = 1:numel(blocks), said = [said, evalc(blocks{i}{1})]; end %#ok<AGROW>
disp(said)
expected = {'x_RiseTime *[:=] *0\.73', 'max_tilt *[:=] *0\.16', 'stays on the plate up to 15 ms', ...
            'ball.mass: found -1; allowed: a mass greater than 0, such as 0.1 or "100 g"'};
for i = 1:numel(expected)
  if isempty(regexp(said, expected{i}, 'once')), error('there is no %s', expected{i}); end
end
end
