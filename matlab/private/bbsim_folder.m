function [folder, remove] = bbsim_folder()
% A folder for files that pass between here and the program. It is deleted with `remove`.

% SPDX-FileCopyrightText: 2026 the bbsim authors
% SPDX-License-Identifier: BSD-3-Clause

folder = tempname();
[made, why] = mkdir(folder);
if ~made, error('bbsim:output', 'bbsim: cannot make the folder %s: %s', folder, why); end
remove = onCleanup(@() remove_folder(folder));
end

function remove_folder(folder)
if exist('OCTAVE_VERSION', 'builtin'), confirm_recursive_rmdir(false, 'local'); end
rmdir(folder, 's');
end
