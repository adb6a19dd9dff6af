// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keeps track of named temporary files, so that a signal that ends the process removes them.
#pragma once

namespace bbsim::file {

// remove_temporaries() removes `name` until forget_temporary(). The characters must stay in place
// until then. There is room for 64 names; further ones are not removed.
void remember_temporary(const char* name);
void forget_temporary(const char* name);

// A signal handler may call this. Does nothing in a forked process.
void remove_temporaries();

}  // namespace bbsim::file
