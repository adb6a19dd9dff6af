// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/journal.hpp"

#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "base/fnv1a.hpp"
#include "file/own_file.hpp"
#include "sweep/plan_text.hpp"

namespace bbsim::sweep {
namespace {

using Word = std::uint64_t;

constexpr std::string_view magic = "bbsim journal 1\n";
// Of a record: its words, its first case, and how many cases it has.
constexpr std::size_t words_before = 3;

void put(std::string& bytes, Word word) {
  bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

void put(std::string& bytes, const std::vector<double>& numbers) {
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
}

// Fills the last word with zeros.
void put(std::string& bytes, std::string_view text) {
  bytes += text;
  bytes.resize((bytes.size() + sizeof(Word) - 1) / sizeof(Word) * sizeof(Word));
}

Word word_at(std::string_view bytes, std::size_t place) {
  Word word = 0;
  std::memcpy(&word, bytes.data() + place, sizeof word);
  return word;
}

std::size_t size_at(std::string_view bytes, std::size_t place) {
  return static_cast<std::size_t>(word_at(bytes, place));
}

// FNV-1a, a word at a time.
Word check_of(Word start, std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(Word)) {
    start = fnv1a(start, word_at(bytes, i));
  }
  return start;
}

bool is_sound(Word start, std::string_view bytes) {
  const std::size_t last = bytes.size() - sizeof(Word);
  return check_of(start, bytes.substr(0, last)) == word_at(bytes, last);
}

std::string head_of(std::string_view plan) {
  std::string head(magic);
  put(head, Word{plan.size()});
  put(head, plan);
  put(head, check_of(fnv1a_start, head));
  return head;
}

}  // namespace

Journal::Journal(const std::string& target, const SweepTask& task, CaseRange range,
                 const std::string& plan, bool resume)
    : target_(file::find_target(target)),
      name_(target_.path + ".part"),
      task_(task),
      range_(range),
      head_(head_of(plan)),
      start_(word_at(head_, head_.size() - sizeof(Word))) {
  open_and_lock();
  const bool is_new = size_ == 0;
  try {
    if (!is_new) check_plan(resume, plan);
    if (target_.found) {
      if (const int error = file::take_after(descriptor_.get(), *target_.found))
        fail("write", error);
    }
    if (size_ == 0) {
      write(head_);
    } else {
      restore();
    }
  } catch (...) {
    if (is_new) discard();  // the destructor does not run if the constructor throws
    throw;
  }
}

Journal::~Journal() {
  if (ends_.empty()) discard();
}

std::string Journal::name_of(const std::string& target) {
  return file::follow_links(target).value_or(target) + ".part";
}

void Journal::open_and_lock() {
  constexpr int most_attempts = 100;  // other processes may begin and end meanwhile
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    descriptor_ = file::open_own_file(name_);
    int locked = 0;
    do {
      locked = flock(descriptor_.get(), LOCK_EX | LOCK_NB);
    } while (locked != 0 && errno == EINTR);
    if (locked != 0 && errno == EWOULDBLOCK) {
      throw InputError(
          name_ +
          ": another bbsim is writing to it; wait until it ends, or choose another name with -o");
    }
    // Some cluster file systems have no locks. Go on there: two sweeps to one target are rare.
    if (locked != 0 && errno != ENOSYS && errno != ENOLCK && errno != EOPNOTSUPP) {
      fail("lock", errno);
    }
    if (!in_place()) continue;  // another process has just finished with it
    struct stat status {};
    if (fstat(descriptor_.get(), &status) != 0) fail("look at", errno);
    size_ = status.st_size;
    return;
  }
  fail("lock", EBUSY);
}

// Allows only a sweep with the same plan to continue a journal. Empties one whose plan was not
// written completely.
void Journal::check_plan(bool resume, const std::string& plan) {
  std::string found(static_cast<std::size_t>(size_), '\0');
  constexpr std::size_t most = std::size_t{64} * 1024 * 1024;  // bytes of a plan
  found.resize(std::min(found.size(), std::max(head_.size(), most)));
  const ssize_t got = file::read_at(descriptor_.get(), found.data(), found.size(), 0);
  if (got < 0) fail("read", errno);
  found.resize(static_cast<std::size_t>(got));
  const std::string start = found.substr(0, head_.size());
  const bool never_written = start.find_first_not_of('\0') == std::string::npos;
  if (!never_written && !start.starts_with(magic.substr(0, start.size()))) {
    const bool rows = start.starts_with("case,");
    throw InputError(
        name_ + ": found " +
        (rows ? "CSV rows, as bbsim 0.3.0 wrote them" : "no journal of a sweep") +
        "; allowed: a journal of this version; " +
        (rows ? "finish the sweep with the version that began it, or remove this file, " +
                    target_.path + ".plan and " + name_ + ".series to start again"
              : "remove it, or choose another name with -o"));
  }
  if (!resume) {
    throw InputError(name_ +
                     ": found, from a sweep that did not end; add --resume to continue it, or "
                     "remove the file to start again");
  }
  if (start == head_) return;
  if (never_written || head_.starts_with(start)) {  // it ended before its first case
    if (never_written) {
      kept_.trouble = name_ + ": the plan is not as it was written; continuing from case " +
                      std::to_string(range_.first);
    }
    return keep_only(0);
  }
  const std::size_t text = magic.size() + sizeof(Word);
  const std::size_t size = found.size() < text ? 0 : size_at(found, magic.size());
  const std::string other = found.substr(std::min(text, found.size()), size);
  const bool sound = found.starts_with(head_of(other));
  const PlanDifference difference = compare_plans(sound ? other : "", plan);
  if (!difference.keys.empty()) {
    throw InputError(name_ + ": is of another sweep than this one: its plan differs in its " +
                     difference.keys +
                     "; allowed with --resume: the same scenario, tables, keys, seed, measures and "
                     "shard, by the same version of bbsim");
  }
  throw InputError(name_ + ": begun with the instruction set " + difference.instruction_sets[0] +
                   ", and this is " + difference.instruction_sets[1] +
                   ", whose results differ in the last digits; continue on a machine with the "
                   "first one (BBSIM_SIMD=" +
                   difference.instruction_sets[0] + "), or remove it to start again");
}

void Journal::restore() {
  CaseResults results;
  auto place = static_cast<off_t>(head_.size());
  for (off_t end = 0; place < size_; place = end) {
    const Fault fault = read_record(place, next_case(), results, end);
    if (fault == Fault::damaged) {
      const std::string number = std::to_string(next_case());
      kept_.trouble = name_ + ": the record of case " + number +
                      " is not as it was written; continuing from case " + number;
    }
    if (fault != Fault::none) break;
    kept_.statuses.add(task_, results);
    kept_.cases += results.count;
    ends_.push_back(next_case() + results.count);
    places_.push_back(place);
  }
  keep_only(place);
}

std::size_t Journal::least_words(std::size_t cases) const {
  const std::size_t numbers = task_.plan.axes().size() + 1 + task_.measures.size() +
                              task_.series.size() * task_.series_rows;
  return words_before + cases * numbers + 1;
}

void Journal::encode(CaseResults& results) const {
  std::string& bytes = results.text;
  bytes.clear();
  bytes.reserve(least_words(results.count) * sizeof(Word));
  put(bytes, 0);  // its length, below
  put(bytes, Word{results.first});
  put(bytes, Word{results.count});
  put(bytes, results.values);
  put(bytes, results.numbers);
  for (const std::vector<double>& column : results.series) put(bytes, column);
  // Most cases are done, without a reason; the others follow.
  for (std::size_t i = 0; i < results.count; ++i) {
    const auto& [word, reason] = results.status[i];
    if (word == "done" && reason.empty()) continue;
    put(bytes, Word{i});
    put(bytes, Word{word.size()});
    put(bytes, Word{reason.size()});
    put(bytes, word + reason);
  }
  const Word words = bytes.size() / sizeof(Word) + 1;
  std::memcpy(bytes.data(), &words, sizeof words);
  put(bytes, check_of(start_, bytes));
}

// The opposite of encode(), for a record without its checksum.
bool Journal::decode(std::string_view record, CaseResults& results) const {
  std::size_t place = words_before * sizeof(Word);
  const auto take = [&](std::vector<double>& numbers) {
    std::memcpy(numbers.data(), record.data() + place, numbers.size() * sizeof(double));
    place += numbers.size() * sizeof(double);
  };
  results.first = size_at(record, sizeof(Word));
  results.resize(size_at(record, 2 * sizeof(Word)), task_);
  take(results.values);
  take(results.numbers);
  for (std::vector<double>& column : results.series) take(column);
  for (CaseStatus& status : results.status) {
    if (status.word != "done" || !status.reason.empty()) status = {};
  }
  while (place < record.size()) {
    if (record.size() - place < 3 * sizeof(Word)) return false;
    const std::size_t i = size_at(record, place), word = size_at(record, place + sizeof(Word)),
                      reason = size_at(record, place + 2 * sizeof(Word));
    place += 3 * sizeof(Word);
    const std::size_t left = record.size() - place;
    if (i >= results.count || word > left || reason > left - word) return false;
    results.status[i] = {std::string(record.substr(place, word)),
                         std::string(record.substr(place + word, reason))};
    place += (word + reason + sizeof(Word) - 1) / sizeof(Word) * sizeof(Word);
  }
  return true;
}

// Reads the record at `place`, which should begin with case `first`.
Journal::Fault Journal::read_record(off_t place, std::size_t first, CaseResults& results,
                                    off_t& end) const {
  std::array<Word, words_before> head{};
  ssize_t got =
      file::read_at(descriptor_.get(), reinterpret_cast<char*>(head.data()), sizeof head, place);
  if (got < 0) fail("read", errno);
  if (got < static_cast<ssize_t>(sizeof head)) return Fault::torn;
  const auto [words, begins, cases] = head;
  if (begins != first || cases == 0 || cases > range_.last - first || words < least_words(cases)) {
    return Fault::damaged;
  }
  if (words > static_cast<Word>(size_ - place) / sizeof(Word)) return Fault::torn;
  std::string& record = results.text;
  record.resize(static_cast<std::size_t>(words) * sizeof(Word));
  got = file::read_at(descriptor_.get(), record.data(), record.size(), place);
  if (got < 0) fail("read", errno);
  if (got < static_cast<ssize_t>(record.size()) || !is_sound(start_, record) ||
      !decode(std::string_view(record).substr(0, record.size() - sizeof(Word)), results)) {
    return Fault::damaged;
  }
  end = place + static_cast<off_t>(record.size());
  return Fault::none;
}

void Journal::append(const CaseResults& results) {
  const off_t place = size_;
  write(results.text);
  places_.push_back(place);
  ends_.push_back(results.first + results.count);
}

void Journal::write(std::string_view bytes) {
  if (const int error = file::write_all(descriptor_.get(), bytes)) fail("write", error);
  size_ += static_cast<off_t>(bytes.size());
  if (flusher_.send(descriptor_.get(), size_)) sync();
}

void Journal::sync() {
  int error = flusher_.sync(descriptor_.get());
  if (error == 0 && !name_synced_) error = file::sync_folder(target_.folder());
  if (error != 0) fail("sync", error);
  name_synced_ = true;
}

void Journal::keep_only(off_t size) {
  if (size == size_) return;
  if (ftruncate(descriptor_.get(), size) != 0) fail("shorten", errno);
  size_ = size;
  flusher_ = file::Flusher(size_);
}

bool Journal::in_place() const {
  return file::is_name_of(name_, descriptor_.get());
}

void Journal::check_complete() const {
  if (next_case() == range_.last) return;
  refuse("it has " + std::to_string(next_case() - range_.first) + " cases of " +
         std::to_string(range_.last - range_.first));
}

void Journal::read(std::size_t first, CaseResults& results) const {
  const auto record = std::ranges::upper_bound(ends_, first) - ends_.begin();
  off_t end = 0;
  if (read_record(places_[static_cast<std::size_t>(record)], first, results, end) != Fault::none) {
    refuse("the record of case " + std::to_string(first) + " is not as it was written");
  }
}

void Journal::discard() {
  if (descriptor_.is_open()) file::remove_own_file(name_, descriptor_.get());
  descriptor_.close();
}

void Journal::refuse(const std::string& fault) const {
  throw OutputError(
      "cannot complete " + name_ + ": " + fault +
      "; run the sweep again with --resume, which continues after the last sound case");
}

void Journal::fail(const std::string& doing, int error) const {
  throw OutputError("cannot " + doing + ' ' + name_ + ": " + file::error_text(error) +
                    (ends_.empty() ? "" : "; --resume continues from its cases"));
}

}  // namespace bbsim::sweep
