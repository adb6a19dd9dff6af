function words = bbsim_common(options)
% The words for Set, Measure and Error, which several commands take.

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

words = {};
set = options.Set;
if ~iscell(set) && ~isempty(set) || mod(numel(set), 2) ~= 0
  error('bbsim:commandLine', 'bbsim: Set: allowed: {KEY, VALUE, ...}');
end
for i = 1:2:numel(set)
  words = [words, {'--set', [char(set{i}) '=' bbsim_json(set{i + 1}, set{i})]}]; %#ok<AGROW>
end
if isfield(options, 'Measure') && ~isempty(options.Measure)
  for measure = reshape(cellstr(options.Measure), 1, [])
    words = [words, {'--measure', measure{1}}]; %#ok<AGROW>
  end
end
if isfield(options, 'Error') && ~isempty(options.Error)
  words = [words, {'--error', bbsim_plain(options.Error)}];
end
end
