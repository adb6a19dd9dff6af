// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The process in which HDF5 files are read.
//
// Debian's HDF5 library crashes on some damaged files and goes in circles on others. So it reads
// in a process of its own (hdf5/reader_program.cpp), which is bounded in time and memory and may
// end in any way: what is left of that here is an error that says so.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>

#include "file/descriptor.hpp"
#include "file/hdf5/messages.hpp"

namespace bbsim::file {

// Why a file could not be read, as the end of a sentence.
class Hdf5Trouble : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// One for all files that are open at a time; it ends a second after the last one was closed, or
// with this program.
class Hdf5Process {
 public:
  // The process that there is, or a new one. Throws Hdf5Trouble.
  [[nodiscard]] static std::shared_ptr<Hdf5Process> running();
  // Files that are opened from now on are read in another one.
  void retire();

  Hdf5Process(pid_t process, Descriptor requests, Descriptor answers);
  ~Hdf5Process();
  Hdf5Process(const Hdf5Process&) = delete;
  Hdf5Process& operator=(const Hdf5Process&) = delete;

  // Whether it ended, as far as one can tell, because it had nothing to do.
  [[nodiscard]] bool ended_idle() const { return ended_idle_; }

 private:
  friend class Hdf5Talk;

  void expect_ready();
  void send(const void* bytes, std::size_t size);
  void receive(void* bytes, std::size_t size);
  void end();
  void hang_up();  // it ends at that, once it is done with what it does
  // Throws Hdf5Trouble for an errno that a line to it met, and does not wait for one that lives on.
  [[noreturn]] void fail(int error);
  // Waits for its end and throws Hdf5Trouble with what it ended by.
  [[noreturn]] void fail_by_end();

  std::mutex mutex_;            // one talk at a time
  std::atomic<pid_t> process_;  // 0 once it is known to have ended
  Descriptor requests_, answers_;
  pid_t owner_;  // whose child it is
  bool ended_idle_ = false;
};

// A request and its answers, in order; other threads wait until it is over. One that is given up
// before its last answer ends the process. Every function throws Hdf5Trouble.
class Hdf5Talk {
 public:
  Hdf5Talk(Hdf5Process& process, hdf5::Message what, std::string_view request);
  ~Hdf5Talk();
  Hdf5Talk(const Hdf5Talk&) = delete;
  Hdf5Talk& operator=(const Hdf5Talk&) = delete;

  // The next answer's kind and size; its bytes are to be taken next.
  [[nodiscard]] hdf5::Head next();
  [[nodiscard]] std::string bytes(const hdf5::Head& head);
  void bytes(const hdf5::Head& head, void* to);

  // The conversation ends after the last answer.
  void over() { over_ = true; }

 private:
  Hdf5Process& process_;
  std::lock_guard<std::mutex> lock_;
  bool over_ = false;
};

}  // namespace bbsim::file
