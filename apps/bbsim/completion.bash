# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Completion of bbsim in bash. The program says how the last word may go on; where it knows nothing,
# bash completes files.

_bbsim() {
  local words
  read -ra words <<<"${COMP_LINE:0:COMP_POINT}"
  [[ ${COMP_LINE:0:COMP_POINT} != *' ' ]] || words+=('')
  mapfile -t COMPREPLY < <("${1/#\~/$HOME}" --words "${words[@]:1}" 2>/dev/null)
  # A key goes on after its dot, and with its value.
  [[ ${COMPREPLY-} != *[.=] ]] || compopt -o nospace 2>/dev/null
}
complete -o bashdefault -o default -F _bbsim bbsim
