// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Root's right to pass by permissions, taken from a process that is to have none but an owner's.
#pragma once

#include <linux/capability.h>
#include <sys/prctl.h>

// For this process's programs to come: to be called between fork() and exec(). Does nothing, and
// need not, for any other user than root.
inline void drop_rights_over_files() {
  prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, 0, 0, 0);
  prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH, 0, 0, 0);
}
