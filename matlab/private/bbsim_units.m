function units = bbsim_units(names)
% The units of output columns; '' for a column of a controller.

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

persistent known
if isempty(known)
  known = containers.Map();
  program = getenv('BBSIM');
  if isempty(program), program = 'bbsim'; end
  [code, text] = system(['"' program '" columns']);
  if code == 0
    found = regexp(text, '^(\w+) +(\S+) ', 'tokens', 'lineanchors');
    for i = 2:numel(found), known(found{i}{1}) = found{i}{2}; end
  end
end
units = repmat({''}, 1, numel(names));
for i = 1:numel(names)
  if known.isKey(names{i}), units{i} = known(names{i}); end
end
end
