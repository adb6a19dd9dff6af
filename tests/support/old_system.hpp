// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Simulates an older system for this process.
#pragma once

#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <cerrno>
#include <cstddef>

// Makes calls fail with the given errno if one of the bits is set in the given argument, counted
// from 0. Returns false if this is not possible.
inline bool refuse_calls(unsigned call, unsigned argument, unsigned bits, unsigned error) {
  const auto place = static_cast<unsigned>(offsetof(seccomp_data, args) + argument * sizeof(__u64));
  sock_filter filter[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 3),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, place),  // lower half of the argument
      BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, bits, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | error),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog program{sizeof filter / sizeof filter[0], filter};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

// File systems without unnamed files.
inline bool refuse_unnamed_files() {
  return refuse_calls(SYS_openat, 2, O_TMPFILE & ~O_DIRECTORY, EOPNOTSUPP);
}

// Linux before 6.10, for users without privileges.
inline bool refuse_empty_paths() {
  return refuse_calls(SYS_linkat, 4, AT_EMPTY_PATH, ENOENT);
}
