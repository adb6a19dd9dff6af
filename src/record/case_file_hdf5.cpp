#include "record/case_file_hdf5.hpp"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include "base/error.hpp"
#include "record/case_text.hpp"
#include "record/part_file.hpp"

namespace bbsim::record {
namespace {

class Hdf5Cases : public CaseFile {
 public:
  Hdf5Cases(const std::string& target, CaseFileLayout layout, const std::string& header,
            const std::string& plan, bool resume)
      : target_(target), layout_(std::move(layout)), part_(target, plan, header, resume) {}
  [[nodiscard]] std::size_t kept() const override { return part_.kept(); }
  void keep_only(std::size_t rows) override { part_.drop_lines_after(rows); }
  [[nodiscard]] std::string part() const override { return part_.name(); }
  void append(std::string_view lines, const std::vector<std::vector<double>>&) override {
    part_.append(lines);
  }
  void finish(const Attributes&) override {}

 private:
  std::string target_;
  CaseFileLayout layout_;
  PartFile part_;
};

}  // namespace

std::unique_ptr<CaseFile> open_case_file_hdf5(const std::string& target, CaseFileLayout layout,
                                              const std::string& header, const std::string& plan,
                                              bool resume) {
  return std::make_unique<Hdf5Cases>(target, std::move(layout), header, plan, resume);
}

}  // namespace bbsim::record
