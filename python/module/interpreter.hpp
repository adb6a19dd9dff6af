// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The interpreter's lock: work without it, calls that need it, and the interpreter's end meanwhile.
//
// Python unwinds a thread that asks for the lock of an interpreter that has ended. Frames of C++
// must not be unwound in this way: it would end the process by SIGABRT. Such a thread therefore
// sleeps until the process ends. So that no thread computes while the process is taken down, the
// interpreter's end first ends all work.
#pragma once

#include <cxxabi.h>
#include <pybind11/pybind11.h>

namespace bbsim::python {

namespace py = pybind11;

[[noreturn]] void sleep_until_the_end();

#ifdef __GLIBCXX__
using Unwound = abi::__forced_unwind;
#else
struct Unwound {};  // here, the end of a thread unwinds nothing
#endif

// Does the work with the lock, from a thread that may not have it.
template <class Does>
auto with_lock(const Does& does) {
  try {
    const py::gil_scoped_acquire lock;
    try {
      return does();
    } catch (const Unwound&) {
      sleep_until_the_end();  // before the lock, which this thread has no more, is given back
    }
  } catch (const Unwound&) {
    sleep_until_the_end();
  }
}

// While it exists, the thread computes without the lock. Create it with the lock.
class WithoutLock {
 public:
  WithoutLock();
  ~WithoutLock();
  WithoutLock(const WithoutLock&) = delete;
  WithoutLock& operator=(const WithoutLock&) = delete;

 private:
  PyThreadState* state_;
};

// Registers what ends all work at the interpreter's end.
void end_work_with_the_interpreter();

}  // namespace bbsim::python
