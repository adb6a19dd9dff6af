// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A file that grows during a long run. It stays if the run ends early, and a later run can resume
// it.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>

#include "file/descriptor.hpp"
#include "file/flusher.hpp"
#include "file/target.hpp"

namespace bbsim::sweep {

// Bytes go to TARGET.part, beside the file itself if the target is a link. TARGET.plan beside it
// identifies the sweep, so that no other sweep resumes the part. commit() gives the part its final
// name. Without commit(), the destructor leaves both files, unless the part has nothing worth
// keeping. The part is locked and read through the same descriptor, so renaming it does no harm.
//
// Every function throws OutputError if the system refuses an operation.
class PartFile {
 public:
  // Throws InputError if a part exists, unless `resume` is set and the plans are the same. Throws
  // InputError if another process writes to the part.
  PartFile(const std::string& target, std::string plan, bool resume);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  // All names that a sweep to this target writes to, except the target.
  [[nodiscard]] static std::vector<std::string> names_beside(const std::string& target);

  [[nodiscard]] const std::string& name() const { return part_; }
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  // The number of bytes kept and appended.
  [[nodiscard]] off_t size() const { return size_; }
  // Whether the part still has its name.
  [[nodiscard]] bool in_place() const;

  void keep_only(off_t size);
  // Writes bytes to the system immediately, and to the disk within seconds.
  void append(std::string_view bytes);
  // Sets whether the part stays if the run ends early.
  void set_worth_keeping(bool worth) { worth_keeping_ = worth; }
  [[nodiscard]] bool is_worth_keeping() const { return worth_keeping_; }
  // Makes all bytes so far survive a power cut.
  void sync();

  // Renames the part to the target, with the permissions of the file that it replaces. If the part
  // has lost its name, writes a copy instead. Removes the plan unless `keep_plan` is set.
  void commit(bool keep_plan);
  // Removes part and plan, whose content is now elsewhere.
  void discard();

  // Throws OutputError: "cannot DOING PART: ", and the system's text for the errno.
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
