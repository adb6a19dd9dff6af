// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The journal of a sweep: its plan, and the results of its cases so far. It stays if the run ends
// early, and a later run continues it.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "file/descriptor.hpp"
#include "file/target.hpp"
#include "sweep/case_rows.hpp"
#include "sweep/sweep.hpp"

namespace bbsim::sweep {

// The cases of an earlier, unfinished run.
struct KeptCases {
  std::size_t cases = 0;  // the first ones
  StatusCounts statuses;
  std::string trouble;  // a sentence: why others were dropped; empty if none were
};

// TARGET.part, beside the file itself if the target is a link. It begins with the plan, which
// identifies the sweep, so that no other sweep continues it. A record for each delivered block of
// cases follows: words of 8 bytes, the last of them a checksum. The file only grows, under a lock.
// The destructor removes a journal without cases; only discard() removes one with cases.
//
// Every function throws OutputError if the system refuses an operation.
class Journal {
 public:
  // The journal of the cases in `range`. Keeps the records of an earlier run up to the first that
  // is damaged. Throws InputError if a journal exists, unless `resume` is set and the plans are the
  // same, and if another process writes to it.
  Journal(const std::string& target, const SweepTask& task, CaseRange range,
          const std::string& plan, bool resume);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  [[nodiscard]] static std::string name_of(const std::string& target);

  [[nodiscard]] const KeptCases& kept() const { return kept_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  // Whether the journal still has its name.
  [[nodiscard]] bool in_place() const;

  // Writes the record of a block into its text. Any thread may call it.
  void encode(CaseResults& results) const;
  // Appends an encoded block: to the system immediately, to the disk within seconds.
  void append(const CaseResults& results);
  // Makes all records so far survive a power cut.
  void sync();

  // Throws unless all cases are there.
  void check_complete() const;
  // For each record, the case after its last one.
  [[nodiscard]] const std::vector<std::size_t>& ends() const { return ends_; }
  // Reads the record that begins with a case, and throws if it is damaged. Any thread may call it.
  void read(std::size_t first, CaseResults& results) const;

  void discard();

 private:
  enum class Fault { none, torn, damaged };

  void open_and_lock();
  void check_plan(bool resume, const std::string& plan);
  void restore();
  [[nodiscard]] std::size_t least_words(std::size_t cases) const;
  [[nodiscard]] Fault read_record(off_t place, std::size_t first, CaseResults& results,
                                  off_t& end) const;
  [[nodiscard]] bool decode(std::string_view record, CaseResults& results) const;
  [[nodiscard]] std::size_t next_case() const {
    return ends_.empty() ? range_.first : ends_.back();
  }
  void keep_only(off_t size);
  void write(std::string_view bytes);
  [[noreturn]] void refuse(const std::string& fault) const;
  // Throws OutputError: "cannot DOING PART: ", and the system's text for the errno.
  [[noreturn]] void fail(const std::string& doing, int error) const;

  file::Target target_;
  std::string name_;
  const SweepTask& task_;
  CaseRange range_;
  std::string head_;     // the first bytes, with the plan
  std::uint64_t start_;  // of all checksums: the plan's
  file::Descriptor descriptor_;
  off_t size_ = 0;
  file::Flusher flusher_;
  bool name_synced_ = false;
  KeptCases kept_;
  std::vector<std::size_t> ends_;
  std::vector<off_t> places_;  // where each record begins
};

}  // namespace bbsim::sweep
