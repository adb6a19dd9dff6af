#include "record/case_file.hpp"

#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "record/atomic_file.hpp"
#include "record/case_file_hdf5.hpp"
#include "record/part_file.hpp"

namespace bbsim::record {
namespace {

std::string header_of(const std::vector<CaseColumn>& columns) {
  std::string line;
  for (const CaseColumn& column : columns) {
    if (column.kind == CaseKind::series) continue;
    if (!line.empty()) line += ',';
    line += column.name;
  }
  return line;
}

// A pipe, a device, standard output: rows as they come.
class Stream : public CaseFile {
 public:
  Stream(const std::string& target, const std::string& header) : file_(target) {
    file_.write(header + '\n');
  }

  [[nodiscard]] std::size_t kept() const override { return 0; }
  void keep_only(std::size_t) override {}
  [[nodiscard]] std::string part() const override { return ""; }
  void append(std::string_view lines, const std::vector<std::vector<double>>&) override {
    file_.write(lines);
  }
  void finish(const Attributes&) override { file_.commit(); }

 private:
  AtomicFile file_;
};

class Csv : public CaseFile {
 public:
  Csv(const std::string& target, const std::string& header, const std::string& plan, bool resume)
      : file_(target, plan, header, resume) {}

  [[nodiscard]] std::size_t kept() const override { return file_.kept(); }
  void keep_only(std::size_t rows) override { file_.drop_lines_after(rows); }
  [[nodiscard]] std::string part() const override { return file_.name(); }
  void append(std::string_view lines, const std::vector<std::vector<double>>&) override {
    file_.append(lines);
  }
  void finish(const Attributes& /*CSV has no place for them*/) override { file_.commit(); }

 private:
  PartFile file_;
};

}  // namespace

std::unique_ptr<CaseFile> open_case_file(const std::string& target, CaseFileLayout layout,
                                         const std::string& plan, bool resume) {
  const std::string header = header_of(layout.columns);
  const bool series = !layout.axis_values.empty();
  const auto refuse_series = [&] {
    if (series) {
      throw InputError("cannot keep trajectories in " + target +
                       ": they need a file that ends in .h5 or .hdf5");
    }
  };
  if (is_written_directly(target)) {
    refuse_series();
    if (resume) {
      throw InputError("cannot resume on " + target +
                       ": only a file in a folder keeps what was done");
    }
    return std::make_unique<Stream>(target, header);
  }
  const std::string ending = std::filesystem::path(target).extension();
  if (ending == ".h5" || ending == ".hdf5") {
    return open_case_file_hdf5(target, std::move(layout), header, plan, resume);
  }
  if (ending != ".csv") {
    throw InputError("cannot tell the format of " + target +
                     " by its name; allowed endings: .csv, .h5, .hdf5");
  }
  refuse_series();
  return std::make_unique<Csv>(target, header, plan, resume);
}

}  // namespace bbsim::record
