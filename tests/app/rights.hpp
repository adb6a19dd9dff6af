// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Removes root's right to override file permissions, which would hide permission errors.
#pragma once

#include <linux/capability.h>
#include <sys/prctl.h>

// Call between fork() and exec(). Does nothing for users other than root, who lack the right
// anyway.
inline void drop_rights_over_files() {
  prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, 0, 0, 0);
  prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH, 0, 0, 0);
}
