// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// SIGINT (Ctrl-C), SIGTERM and SIGHUP end the program with exit code 130, and leave no temporary
// files; a run that watches them keeps what it reached.
#pragma once

#include <atomic>

namespace bbsim::app {

// From now on each of these signals ends the process at once. SIGHUP stays ignored if it is
// (nohup).
void end_at_signals();

// Becomes true when the process is asked to end, which from now on takes a second request to be
// done at once.
const std::atomic<bool>& watch_signals();

}  // namespace bbsim::app
