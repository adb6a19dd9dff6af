function text = bbsim_json(value, path)
% A value as JSON, which is also YAML. jsonencode rounds numbers to 15 digits; here they keep all
% bits. `path` is the key's, for messages.

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

if isa(value, 'containers.Map')
  text = mapping(value.keys(), value.values(), path);
elseif isstruct(value) && isscalar(value)
  text = mapping(fieldnames(value)', struct2cell(value)', path);
elseif isstruct(value)
  text = list(num2cell(value(:)'), path);
elseif iscell(value)
  text = list(value(:)', path);
elseif ischar(value)
  text = quoted(value);
elseif isa(value, 'string')
  if isscalar(value)
    text = quoted(char(value));
  else
    text = list(cellstr(value(:)'), path);
  end
elseif isempty(value)
  text = 'null';
elseif islogical(value) && isscalar(value)
  if value, text = 'true'; else, text = 'false'; end
elseif (isnumeric(value) || islogical(value)) && isreal(value)
  text = numbers(double(value), path);
else
  error('bbsim:scenario', 'bbsim: %s: found a value of class %s; allowed: %s', path, ...
        class(value), 'numbers, text, structs, cell arrays');
end
end

function text = mapping(names, values, path)
parts = cell(1, numel(names));
for i = 1:numel(names)
  key = names{i};
  if ~isempty(path), key = [path '.' names{i}]; end
  parts{i} = [quoted(names{i}) ': ' bbsim_json(values{i}, key)];
end
text = ['{' strjoin(parts, ', ') '}'];
end

function text = list(values, path)
parts = cell(1, numel(values));
for i = 1:numel(values)
  parts{i} = bbsim_json(values{i}, sprintf('%s.%d', path, i - 1));
end
text = ['[' strjoin(parts, ', ') ']'];
end

function text = numbers(values, path)
if ~all(isfinite(values(:)))
  error('bbsim:scenario', 'bbsim: %s: found a number that is not finite; allowed: finite numbers', ...
        path);
end
if isscalar(values)
  text = sprintf('%.17g', values);
elseif isvector(values)
  text = ['[' strjoin(arrayfun(@(v) sprintf('%.17g', v), values(:)', 'UniformOutput', false), ', ') ']'];
else
  rows = cell(1, size(values, 1));
  for i = 1:numel(rows), rows{i} = numbers(values(i, :), path); end
  text = ['[' strjoin(rows, ', ') ']'];
end
end

function text = quoted(value)
text = strrep(strrep(value, '\', '\\'), '"', '\"');
text = ['"' strrep(strrep(text, sprintf('\n'), '\n'), sprintf('\t'), '\t') '"'];
end
