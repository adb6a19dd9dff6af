function text = bbsim_plain(value)
% A value as a word of the command line: text as it stands, a number to its last bit.

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

if isnumeric(value) || islogical(value)
  text = bbsim_json(value, '');
else
  text = char(value);
end
end
