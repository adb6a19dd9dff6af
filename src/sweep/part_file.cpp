// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/part_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <utility>

#include "base/error.hpp"
#include "file/atomic_file.hpp"
#include "file/own_file.hpp"
#include "sweep/plan_text.hpp"

namespace bbsim::sweep {

PartFile::PartFile(const std::string& target, std::string plan, bool resume)
    : target_(file::find_target(target)),
      part_(target_.path + ".part"),
      plan_(target_.path + ".plan"),
      plan_text_(std::move(plan)) {
  open_and_lock();
  try {
    if (size_ > 0) {
      worth_keeping_ = true;
      check_plan(resume);
      plan_descriptor_ = std::move(file::open_own_file(plan_).descriptor);
    } else {
      write_plan();
    }
    if (target_.found) {
      if (const int error = file::take_after(descriptor_.get(), *target_.found))
        fail("write", error);
    }
  } catch (...) {
    if (!worth_keeping_) discard();  // the destructor does not run if the constructor throws
    throw;
  }
  flusher_ = file::Flusher(size_);
}

PartFile::~PartFile() {
  if (descriptor_.is_open() && !worth_keeping_) discard();
}

std::vector<std::string> PartFile::names_beside(const std::string& target) {
  const std::string path = file::follow_links(target).value_or(target);
  return {path + ".part", path + ".plan", path + ".part.series"};
}

// Comes first, because the plan belongs to the process that writes to the part.
void PartFile::open_and_lock() {
  constexpr int most_attempts = 100;  // other processes may begin and end meanwhile
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    descriptor_ = std::move(file::open_own_file(part_).descriptor);
    int locked = 0;
    do {
      locked = flock(descriptor_.get(), LOCK_EX | LOCK_NB);
    } while (locked != 0 && errno == EINTR);
    if (locked != 0 && errno == EWOULDBLOCK) {
      throw InputError(
          part_ +
          ": another bbsim is writing to it; wait until it ends, or choose another name with -o");
    }
    // Some cluster file systems have no locks. Go on there: two sweeps to one target are rare.
    if (locked != 0 && errno != ENOSYS && errno != ENOLCK && errno != EOPNOTSUPP) {
      fail("lock", errno);
    }
    if (!file::is_name_of(part_, descriptor_.get()))
      continue;  // another process has just finished with it
    struct stat status {};
    if (fstat(descriptor_.get(), &status) != 0) fail("look at", errno);
    size_ = status.st_size;
    return;
  }
  fail("lock", EBUSY);
}

// Allows only a sweep with the same plan to resume an existing part.
void PartFile::check_plan(bool resume) const {
  if (!resume) {
    throw InputError(part_ +
                     ": found, from a sweep that did not end; add --resume to continue it, or "
                     "remove the file to start again");
  }
  const file::OwnText found = file::read_own_file(plan_);
  if (!found.there) {
    throw InputError(part_ + ": found without " + plan_ +
                     ", which names its sweep; remove it to start again");
  }
  if (found.text == plan_text_) return;
  const PlanDifference difference = compare_plans(found.text, plan_text_);
  if (!difference.keys.empty()) {
    throw InputError(part_ + ": is of another sweep than this one: " + plan_ + " differs in its " +
                     difference.keys +
                     "; allowed with --resume: the same scenario, tables, keys, seed, measures and "
                     "shard, by the same version of bbsim");
  }
  throw InputError(part_ + ": begun with the instruction set " + difference.instruction_sets[0] +
                   ", and this is " + difference.instruction_sets[1] +
                   ", whose results differ in the last digits; continue on a machine with the "
                   "first one (BBSIM_SIMD=" +
                   difference.instruction_sets[0] + "), or remove it to start again");
}

void PartFile::write_plan() {
  plan_descriptor_ = std::move(file::open_own_file(plan_).descriptor);
  int error = ftruncate(plan_descriptor_.get(), 0) == 0 ? 0 : errno;
  if (error == 0 && target_.found) error = file::take_after(plan_descriptor_.get(), *target_.found);
  if (error == 0) error = file::write_all(plan_descriptor_.get(), plan_text_);
  if (error != 0) file::fail_to_write(plan_, error);
}

bool PartFile::in_place() const {
  return file::is_name_of(part_, descriptor_.get());
}

void PartFile::keep_only(off_t size) {
  if (size == size_) return;
  if (ftruncate(descriptor_.get(), size) != 0) fail("shorten", errno);
  size_ = size;
  flusher_ = file::Flusher(size_);
}

void PartFile::append(std::string_view bytes) {
  if (const int error = file::write_all(descriptor_.get(), bytes)) fail("write", error);
  size_ += static_cast<off_t>(bytes.size());
  const file::Flusher::Due due = flusher_.due(size_);
  if (due == file::Flusher::Due::nothing) return;
  sync_names();
  if (const int error = flusher_.perform(due, descriptor_.get(), size_)) fail("sync", error);
}

// Call this before any row is on the disk, so that no row lacks its plan.
void PartFile::sync_names() {
  if (names_synced_) return;
  int error = file::sync_content(plan_descriptor_.get());
  if (error == 0) error = file::sync_folder(target_.folder());
  if (error != 0) fail("sync", error);
  names_synced_ = true;
}

void PartFile::sync() {
  sync_names();
  if (const int error = flusher_.perform(file::Flusher::Due::sync, descriptor_.get(), size_)) {
    fail("sync", error);
  }
}

void PartFile::check_size() const {
  struct stat status {};
  if (fstat(descriptor_.get(), &status) != 0) fail("look at", errno);
  if (status.st_size == size_) return;
  throw OutputError(
      "cannot complete " + part_ + ": found " + std::to_string(status.st_size) + " bytes where " +
      std::to_string(size_) +
      " were written: something else has changed it; remove it, and run the sweep again");
}

void PartFile::commit(bool keep_plan) {
  check_size();
  if (const int error = file::sync_content(descriptor_.get())) fail("sync", error);
  const bool in_its_place = in_place();
  if (in_its_place) {
    struct stat status {};
    if (lstat(target_.path.c_str(), &status) == 0 && S_ISREG(status.st_mode)) {
      if (const int error = file::take_after(descriptor_.get(), status)) fail("write", error);
    }
    if (std::rename(part_.c_str(), target_.path.c_str()) != 0) fail("rename", errno);
    if (!keep_plan) file::remove_own_file(plan_, plan_descriptor_.get());
    if (const int error = file::sync_folder(target_.folder())) fail("sync the folder of", error);
  } else {
    copy_to_target();  // the names beside the target may now be another sweep's
  }
  if (const int error = descriptor_.close()) fail("write", error);  // also unlocks
}

void PartFile::copy_to_target() const {
  file::AtomicFile copy(target_.path, file::Durable::yes);
  std::array<char, 65536> buffer;
  for (off_t place = 0; place < size_;) {
    const auto left = static_cast<std::size_t>(size_ - place);
    const ssize_t size =
        file::read_at(descriptor_.get(), buffer.data(), std::min(buffer.size(), left), place);
    if (size <= 0) fail("read", size < 0 ? errno : EIO);
    copy.write({buffer.data(), static_cast<std::size_t>(size)});
    place += size;
  }
  copy.commit();
}

void PartFile::discard() {
  if (!descriptor_.is_open()) return;
  if (in_place()) {  // otherwise the plan is another sweep's
    file::remove_own_file(part_, descriptor_.get());
    // A part that cannot be removed keeps its plan.
    if (plan_descriptor_.is_open() && !in_place())
      file::remove_own_file(plan_, plan_descriptor_.get());
  }
  descriptor_.close();
}

void PartFile::fail(const std::string& doing, int error) const {
  throw OutputError("cannot " + doing + ' ' + part_ + ": " + file::error_text(error) +
                    (size_ > 0 ? "; --resume continues from its rows" : ""));
}

}  // namespace bbsim::sweep
