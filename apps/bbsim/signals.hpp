// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// SIGINT (Ctrl-C), SIGTERM and SIGHUP end the program with exit code 130 and leave no temporary
// files. A run that watches them keeps its results so far.
#pragma once

#include <atomic>

namespace bbsim::app {

// From now on each of these signals ends the process at once. An ignored SIGHUP (nohup) stays
// ignored.
void end_at_signals();

// Becomes true when a signal asks the process to end. From now on only a second signal ends it at
// once.
const std::atomic<bool>& watch_signals();

}  // namespace bbsim::app
