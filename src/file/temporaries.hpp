// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Temporary files with a name, which a signal that ends the process must take with it.
#pragma once

namespace bbsim::file {

// `name` is removed by remove_temporaries() until it is forgotten; its characters stay where they
// are until then. A name that finds no place (of 64) is only not removed.
void remember_temporary(const char* name);
void forget_temporary(const char* name);

// What a signal handler may call. Does nothing in a process that was forked off.
void remove_temporaries();

}  // namespace bbsim::file
