function data = bbsim_table(name, has_units)
% A CSV file of bbsim: a table in MATLAB, a struct of columns in Octave. Rows of runs are numbers
% with units; those of sweeps also have text.

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

file = fopen(name, 'r', 'n', 'UTF-8');
close_file = onCleanup(@() fclose(file));
header = strsplit(fgetl(file), ',');
if has_units
  values = numbers(fread(file, [1 Inf], '*char'), numel(header));
else
  values = textscan(file, repmat('%q', 1, numel(header)), 'Delimiter', ',', 'EndOfLine', '\n');
  for i = 1:numel(values)
    if ~any(strcmp(header{i}, {'status', 'reason'})), values{i} = numbers_in(values{i}); end
  end
end
variables = regexprep(header, '\W', '_');
if exist('OCTAVE_VERSION', 'builtin')
  data = cell2struct(values(:), variables(:), 1);
  return
end
data = table(values{:}, 'VariableNames', variables);
data.Properties.VariableDescriptions = header;
if has_units, data.Properties.VariableUnits = bbsim_units(header); end
end

% The columns of rows of numbers. In Octave, textscan's %f often misses the last bit.
function columns = numbers(text, width)
values = sscanf(strrep(text, ',', ' '), '%f');
columns = num2cell(reshape(values, width, [])', 1);
if isempty(values), columns = repmat({zeros(0, 1)}, 1, width); end
end

% Varied values may be words, such as those of solver.method.
function values = numbers_in(fields)
values = str2double(fields);
if any(isnan(values) & ~strcmpi(fields, 'nan') & ~strcmp(fields, '')), values = fields; end
end
