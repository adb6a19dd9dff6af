function problems = bbsim_problems(fault)
%BBSIM_PROBLEMS  What is wrong with a scenario, key by key.
%   PROBLEMS = BBSIM_PROBLEMS(FAULT) reads an error that BBSIM_RUN, BBSIM_SWEEP or BBSIM_LINEARIZE
%   threw. It returns a struct array, one element per mistake:
%     where    the place, such as scenario.yaml:3:7; empty for a struct
%     key      the key's path, such as ball.radius; empty if there is none
%     message  what was found
%     hint     what is allowed, or the nearest name; empty if there is none
%
%       try
%         bbsim_run(scenario);
%       catch fault
%         for problem = bbsim_problems(fault)', disp([problem.key ': ' problem.hint]), end
%       end

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

problems = struct('where', {}, 'key', {}, 'message', {}, 'hint', {});
for line = strsplit(regexprep(fault.message, '^bbsim: ', ''), sprintf('\n'))
  text = strtrim(line{1});
  if isempty(text), continue, end
  parts = regexp(text, ['^(?<where>.*?:\d+:\d+: |--[a-z]+ \S+: )?(?<key>[A-Za-z]\w*(\.\w+)*: )?' ...
                        '(?<message>.*?)(; (allowed: )?(?<hint>(?<=allowed: ).*|did you mean .*))?$'], ...
                 'names', 'once');
  problems(end + 1, 1) = struct('where', regexprep(parts.where, ': $', ''), ...
                                'key', regexprep(parts.key, ': $', ''), ...
                                'message', parts.message, 'hint', parts.hint); %#ok<AGROW>
end
end
