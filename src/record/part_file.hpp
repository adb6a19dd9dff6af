// A file that grows over a long run, stays when the run ends early, and can be taken up again.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bbsim::record {

// Lines go to TARGET.part, beside the file itself if the target is a link; beside it TARGET.plan
// says what is being done, so that nothing else is taken up in its place. commit() gives the part
// its final name and removes the plan. Destroyed without it, both stay, but for a part without a
// line beside its header.
//
// Every function throws OutputError where the system refuses something.
class PartFile {
 public:
  // A part that is there already is an InputError, unless `resume` is set and its plan is the same:
  // then its complete lines are kept. A part that another process writes to is an InputError too.
  // `header` is the first line, without its line break.
  PartFile(const std::string& target, const std::string& plan, const std::string& header,
           bool resume);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  // Lines below the header that were kept.
  [[nodiscard]] std::size_t kept() const { return kept_; }
  [[nodiscard]] const std::string& name() const { return part_; }
  // Whether there is anything below the header.
  [[nodiscard]] bool has_lines() const { return has_lines_; }

  // Keeps only so many of the lines that were kept.
  void drop_lines_after(std::size_t lines);

  // Some whole lines; handed to the system at once.
  void append(std::string_view lines);

  void commit();
  // Removes part and plan: what they hold is elsewhere now.
  void discard();

 private:
  void check_plan(const std::string& plan, bool resume) const;
  void take_up(const std::string& header);
  [[noreturn]] void fail(const std::string& doing, int error) const;

  std::string target_, part_, plan_;
  int descriptor_ = -1;
  std::size_t kept_ = 0;
  bool has_lines_ = false;
};

}  // namespace bbsim::record
