// Processes that run beside this one, which a signal that ends it must take with it.
#pragma once

#include <sys/types.h>

namespace bbsim::controller {

// The process group of that id is ended by end_children() until it is forgotten, which has to be
// before anybody waits for the process: afterwards the id may be another's. One that finds no place
// (of 1100: more than a sweep has threads) is only not ended.
void remember_child(pid_t group);
void forget_child(pid_t group);

// What a signal handler may call. Does nothing in a process that was forked off.
void end_children();

}  // namespace bbsim::controller
