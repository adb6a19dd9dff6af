// Ctrl-C and SIGTERM ask for an end; the run keeps what it reached.
#pragma once

#include <atomic>

namespace bbsim::app {

// Becomes true when the process is asked to end. A second request ends it at once.
const std::atomic<bool>& watch_signals();

}  // namespace bbsim::app
