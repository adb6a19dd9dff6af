function text = bbsim_plain(value)
% A value as a word of the command line: text unchanged, a number with all bits.

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

if isnumeric(value) || islogical(value)
  text = bbsim_json(value, '');
else
  text = char(value);
end
end
