// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Root's right to pass by permissions, taken from a process that is to have none but an owner's.
#pragma once

#include <linux/capability.h>
#include <sys/syscall.h>
#include <unistd.h>

// For this process and its threads to come. Does nothing, and need not, for any other user than
// root.
inline void drop_rights_over_files() {
  __user_cap_header_struct whose{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct rights[2]{};
  if (syscall(SYS_capget, &whose, rights) != 0) return;
  rights[0].effective &= ~((1U << CAP_DAC_OVERRIDE) | (1U << CAP_DAC_READ_SEARCH));
  static_cast<void>(syscall(SYS_capset, &whose, rights));
}
