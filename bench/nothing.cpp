// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Empty process, which startup.cpp compares with bbsim.
int main() {
  return 0;
}
