function code = bbsim_call(folder, command, scenario, words)
% Calls the program and returns its exit code: 0, or 1 for a run that ended early. Any other code is
% an error with the program's message.

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

program = getenv('BBSIM');
if isempty(program), program = 'bbsim'; end
input = '';
if ischar(scenario) || isa(scenario, 'string')
  name = char(scenario);
elseif isstruct(scenario) || isa(scenario, 'containers.Map')
  % By standard input, so that files that it names are relative to the current folder.
  name = '-';
  input = fullfile(folder, 'scenario.json');
  write(input, [bbsim_json(scenario, '') sprintf('\n')]);
else
  error('bbsim:scenario', 'bbsim: found a scenario of class %s; allowed: a struct or a file name', ...
        class(scenario));
end
said = fullfile(folder, 'said.txt');
line = strjoin(cellfun(@quoted, [{program, command, name, '-q'}, words], 'UniformOutput', false), ' ');
if ~isempty(input), line = [line ' < ' quoted(input)]; end
line = [line ' > ' quoted(fullfile(folder, 'printed.txt')) ' 2> ' quoted(said)];
if ispc(), line = ['"' line '"']; end % cmd takes off the outer quotes
code = system(line);
if code == 0, return, end

message = strtrim(regexprep(fileread(said), '(^|\n)standard input:\d+:\d+: ', '$1'));
message = regexprep(message, '\nRun bbsim [^\n]*$', '');
ended_early = code == 1 && strcmp(command, 'run') && exist(fullfile(folder, 'summary.json'), 'file');
if ended_early, return, end
switch code
  case 1, identifier = 'bbsim:endedEarly';
  case 2, identifier = 'bbsim:scenario';
  case 3, identifier = 'bbsim:output';
  case 130, identifier = 'bbsim:interrupted';
  otherwise
    identifier = 'bbsim:program';
    message = sprintf(['%s ended with code %d; allowed: bbsim in the PATH, or its path in the ' ...
                       'environment variable BBSIM. %s'], program, code, message);
end
error(identifier, '%s', ['bbsim: ' message]);
end

function write(name, text)
file = fopen(name, 'w', 'n', 'UTF-8');
fwrite(file, unicode2native(text, 'UTF-8'));
fclose(file);
end

% A word for the shell.
function text = quoted(word)
if ispc()
  text = ['"' strrep(word, '"', '\"') '"'];
else
  text = ['''' strrep(word, '''', '''\''''') ''''];
end
end
