// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The process that startup.cpp compares bbsim with.
int main() {
  return 0;
}
