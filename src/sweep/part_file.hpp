// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A file that grows over a long run, stays when the run ends early, and can be taken up again.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>

#include "file/descriptor.hpp"
#include "file/flusher.hpp"
#include "file/target.hpp"

namespace bbsim::sweep {

// Bytes go to TARGET.part, beside the file itself if the target is a link; beside it TARGET.plan
// says what is being done, so that nothing else is taken up in its place. commit() gives the part
// its final name. Destroyed without it, both stay, unless there is nothing in the part that was
// worth keeping. The part is locked, and read through the same descriptor: what happens to its name
// meanwhile cannot change what becomes of it.
//
// Every function throws OutputError where the system refuses something.
class PartFile {
 public:
  // A part that is there already is an InputError, unless `resume` is set and its plan is the same.
  // A part that another process writes to is an InputError too.
  PartFile(const std::string& target, std::string plan, bool resume);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  // All names that a sweep to this target writes to, but for the target's own.
  [[nodiscard]] static std::vector<std::string> names_beside(const std::string& target);

  [[nodiscard]] const std::string& name() const { return part_; }
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  // Bytes that were kept and appended.
  [[nodiscard]] off_t size() const { return size_; }
  // Whether the part still has its name.
  [[nodiscard]] bool in_place() const;

  void keep_only(off_t size);
  // Hands bytes to the system at once, and to the disk within seconds.
  void append(std::string_view bytes);
  // Says whether the part is to stay should the run end early.
  void set_worth_keeping(bool worth) { worth_keeping_ = worth; }
  [[nodiscard]] bool is_worth_keeping() const { return worth_keeping_; }
  // What is there now survives a power cut.
  void sync();

  // Puts the part under the target's name, with the permissions of what it replaces; should the
  // part have lost its own name, a copy of it. The plan goes, unless it is to stay beside the
  // result.
  void commit(bool keep_plan);
  // Removes part and plan: what they hold is elsewhere now.
  void discard();

  // Throws OutputError for an errno that something met.
  [[noreturn]] void fail(const std::string& doing, int error) const;

 private:
  void open_and_lock();
  void check_plan(bool resume) const;
  void write_plan();
  void sync_names();
  void copy_to_target() const;
  void check_size() const;

  file::Target target_;
  std::string part_, plan_, plan_text_;
  file::Descriptor descriptor_, plan_descriptor_;
  off_t size_ = 0;
  file::Flusher flusher_;
  bool worth_keeping_ = false, names_synced_ = false;
};

}  // namespace bbsim::sweep
