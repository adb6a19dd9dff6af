#include "record/case_file_hdf5.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>

#include "base/error.hpp"
#include "record/atomic_file.hpp"
#include "record/case_text.hpp"
#include "record/part_file.hpp"

namespace bbsim::record {
namespace {

// So many bytes of series, at most, are in memory at a time.
constexpr std::size_t most_bytes = std::size_t{1} << 22U;
constexpr std::size_t most_rows = 1024;

// The series of all cases so far, as plain numbers: of each case one series after the other.
class SeriesPart {
 public:
  SeriesPart(std::string name, std::size_t numbers_a_case, std::size_t cases_to_keep)
      : name_(std::move(name)), numbers_(numbers_a_case) {
    constexpr mode_t any_permissions = 0666;
    descriptor_ = open(name_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, any_permissions);
    if (descriptor_ < 0) fail(errno);
    const off_t size = lseek(descriptor_, 0, SEEK_END);
    kept_ = std::min(cases_to_keep, static_cast<std::size_t>(size) / bytes());
    keep_only(kept_);
  }
  ~SeriesPart() { close(descriptor_); }
  SeriesPart(const SeriesPart&) = delete;
  SeriesPart& operator=(const SeriesPart&) = delete;

  [[nodiscard]] std::size_t kept() const { return kept_; }

  void keep_only(std::size_t cases) {
    if (ftruncate(descriptor_, static_cast<off_t>(cases * bytes())) != 0) fail(errno);
  }

  void append(const std::vector<double>& numbers) {
    const char* from = reinterpret_cast<const char*>(numbers.data());
    for (std::size_t left = numbers.size() * sizeof(double); left > 0;) {
      const ssize_t written = write(descriptor_, from, left);
      if (written < 0 && errno != EINTR) fail(errno);
      if (written < 0) continue;
      from += written;
      left -= static_cast<std::size_t>(written);
    }
  }

  // Cases first ... first + count - 1, as they were appended.
  void read(std::size_t first, std::size_t count, std::vector<double>& numbers) const {
    numbers.resize(count * numbers_);
    char* to = reinterpret_cast<char*>(numbers.data());
    auto place = static_cast<off_t>(first * bytes());
    for (std::size_t left = count * bytes(); left > 0;) {
      const ssize_t size = pread(descriptor_, to, left, place);
      if (size < 0 && errno == EINTR) continue;
      if (size <= 0) fail(size < 0 ? errno : EIO);
      to += size;
      place += size;
      left -= static_cast<std::size_t>(size);
    }
  }

  void remove() const { unlink(name_.c_str()); }

 private:
  [[nodiscard]] std::size_t bytes() const { return numbers_ * sizeof(double); }
  [[noreturn]] void fail(int error) const {
    throw OutputError("cannot use " + name_ + ": " + error_text(error));
  }

  std::string name_;
  std::size_t numbers_, kept_ = 0;
  int descriptor_ = -1;
};

class Hdf5Cases : public CaseFile {
 public:
  Hdf5Cases(const std::string& target, CaseFileLayout layout, const std::string& header,
            const std::string& plan, bool resume)
      : target_(target), layout_(std::move(layout)), part_(target, plan, header, resume) {
    for (const CaseColumn& column : layout_.columns) {
      if (column.kind == CaseKind::series) series_numbers_ += column.width;
    }
    if (series_numbers_ == 0) return;
    series_ = std::make_unique<SeriesPart>(part_.name() + ".series", series_numbers_, part_.kept());
    part_.drop_lines_after(series_->kept());
  }
  ~Hdf5Cases() override {
    if (series_ && !part_.has_lines()) series_->remove();
  }

  [[nodiscard]] std::size_t kept() const override { return part_.kept(); }
  void keep_only(std::size_t rows) override {
    part_.drop_lines_after(rows);
    if (series_) series_->keep_only(part_.kept());
  }
  [[nodiscard]] std::string part() const override { return part_.name(); }

  void append(std::string_view lines, const std::vector<std::vector<double>>& series) override {
    if (series_) {
      const std::size_t cases = series[0].size() / layout_.axis_values.size();
      std::vector<double> numbers;
      numbers.reserve(cases * series_numbers_);
      for (std::size_t i = 0; i < cases; ++i) {
        for (const auto& column : series) {
          const std::size_t width = column.size() / cases;
          const auto from = column.begin() + static_cast<std::ptrdiff_t>(i * width);
          numbers.insert(numbers.end(), from, from + static_cast<std::ptrdiff_t>(width));
        }
      }
      series_->append(numbers);  // before the lines, which say how many cases there are
    }
    part_.append(lines);
  }

  void finish(const Attributes& attributes) override {
    std::vector<CaseAxis> axes;
    if (series_) axes.emplace_back(layout_.axis, layout_.axis_values);
    CaseTableWriter writer(target_, layout_.columns, axes);
    std::ifstream lines(part_.name(), std::ios::binary);
    std::string line;
    std::getline(lines, line);  // the header
    const std::size_t rows =
        series_ ? std::clamp<std::size_t>(most_bytes / (8 * series_numbers_), 1, most_rows)
                : most_rows;
    CaseBlock block;
    clear(block);
    std::size_t first = 0;
    while (std::getline(lines, line)) {
      add_line(line, block);
      if (++block.rows == rows) hand_on(writer, block, first);
    }
    if (block.rows > 0) hand_on(writer, block, first);
    writer.finish(attributes);
    if (series_) series_->remove();
    part_.discard();
  }

 private:
  void clear(CaseBlock& block) const {
    block.rows = 0;
    block.values.assign(layout_.columns.size(), {});
    block.texts.assign(layout_.columns.size(), {});
  }

  void add_line(const std::string& line, CaseBlock& block) {
    const bool whole = split_fields(line, fields_);
    std::size_t next = 0;
    for (std::size_t c = 0; c < layout_.columns.size(); ++c) {
      if (layout_.columns[c].kind == CaseKind::series) continue;
      if (!whole || next == fields_.size()) {
        throw OutputError(part_.name() + ": a row is not as it was written");
      }
      const std::string& field = fields_[next++];
      if (layout_.columns[c].kind == CaseKind::text) {
        block.texts[c].push_back(field);
      } else {
        block.values[c].push_back(number_of(field));
      }
    }
  }

  // nan and inf are among what std::to_chars writes and from_chars reads.
  [[nodiscard]] double number_of(const std::string& field) const {
    double value = 0;
    const auto result = std::from_chars(field.data(), field.data() + field.size(), value);
    if (result.ec != std::errc{} || result.ptr != field.data() + field.size()) {
      throw OutputError(part_.name() + ": found " + field + " for a number");
    }
    return value;
  }

  void hand_on(CaseTableWriter& writer, CaseBlock& block, std::size_t& first) {
    if (series_) {
      series_->read(first, block.rows, numbers_);
      std::size_t offset = 0;
      for (std::size_t c = 0; c < layout_.columns.size(); ++c) {
        if (layout_.columns[c].kind != CaseKind::series) continue;
        const std::size_t width = layout_.columns[c].width;
        for (std::size_t i = 0; i < block.rows; ++i) {
          const auto from =
              numbers_.begin() + static_cast<std::ptrdiff_t>(i * series_numbers_ + offset);
          block.values[c].insert(block.values[c].end(), from,
                                 from + static_cast<std::ptrdiff_t>(width));
        }
        offset += width;
      }
    }
    writer.append(block);
    first += block.rows;
    clear(block);
  }

  std::string target_;
  CaseFileLayout layout_;
  PartFile part_;
  std::size_t series_numbers_ = 0;  // a case
  std::unique_ptr<SeriesPart> series_;
  std::vector<std::string> fields_;
  std::vector<double> numbers_;
};

}  // namespace

std::unique_ptr<CaseFile> open_case_file_hdf5(const std::string& target, CaseFileLayout layout,
                                              const std::string& header, const std::string& plan,
                                              bool resume) {
  return std::make_unique<Hdf5Cases>(target, std::move(layout), header, plan, resume);
}

}  // namespace bbsim::record
