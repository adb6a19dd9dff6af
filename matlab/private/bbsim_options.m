function options = bbsim_options(words, names)
% NAME, VALUE, ... as a struct with a field for each of the names, [] if it is not given.

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

options = cell2struct(cell(numel(names), 1), names(:), 1);
if mod(numel(words), 2) ~= 0
  error('bbsim:commandLine', 'bbsim: found a name without a value; allowed: NAME, VALUE, ...');
end
for i = 1:2:numel(words)
  known = find(strcmpi(char(words{i}), names));
  if isempty(known)
    error('bbsim:commandLine', 'bbsim: unknown option %s; allowed: %s', char(words{i}), ...
          strjoin(names, ', '));
  end
  value = words{i + 1};
  if isa(value, 'string') && isscalar(value), value = char(value); end
  options.(names{known}) = value;
end
end
