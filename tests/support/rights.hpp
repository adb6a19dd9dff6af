// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Removes root's right to override file permissions, which would hide permission errors.
#pragma once

#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

// Applies to this process and its future threads. Does nothing for users other than root, who lack
// the right anyway.
inline void drop_rights_over_files() {
  __user_cap_header_struct whose{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct rights[2]{};
  if (syscall(SYS_capget, &whose, rights) != 0) return;
  rights[0].effective &= ~((1U << CAP_DAC_OVERRIDE) | (1U << CAP_DAC_READ_SEARCH));
  static_cast<void>(syscall(SYS_capset, &whose, rights));
}

// The same for a program that a child process executes next.
inline void drop_rights_before_exec() {
  prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, 0, 0, 0);
  prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH, 0, 0, 0);
}
