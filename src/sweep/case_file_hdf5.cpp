// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/case_file_hdf5.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "file/hdf5_table.hpp"
#include "sweep/case_part.hpp"
#include "sweep/series_part.hpp"

namespace bbsim::sweep {
namespace {

// The greatest size of series data in memory at a time.
constexpr std::size_t most_bytes = std::size_t{1} << 22U;
constexpr std::size_t most_rows = 1024;

class Hdf5Cases : public CaseFile {
 public:
  Hdf5Cases(const std::string& target, CaseFileLayout layout, const std::string& plan, bool resume)
      : target_(target), layout_(std::move(layout)), part_(target, layout_, plan, resume) {
    for (const file::Hdf5Column& column : layout_.columns) {
      if (column.kind == file::Hdf5Kind::series) series_numbers_ += column.width;
    }
    std::size_t most = std::numeric_limits<std::size_t>::max();
    if (series_numbers_ > 0) {
      series_ = std::make_unique<SeriesPart>(part_.file().name() + ".series", series_numbers_,
                                             part_.file().descriptor());
      most = series_->count_kept();
    }
    part_.resume(most);
    if (series_) series_->keep_only(part_.kept().rows);
  }
  ~Hdf5Cases() override {
    if (series_ && !done_ && !part_.file().is_worth_keeping()) series_->remove();
  }

  [[nodiscard]] const KeptRows& kept() const override { return part_.kept(); }
  [[nodiscard]] std::string part() const override {
    return part_.file().in_place() ? part_.file().name() : "";
  }

  void append(std::string_view lines, std::size_t rows,
              const std::vector<std::vector<double>>& series) override {
    // Series come first, because the lines tell how many cases are complete.
    if (series_) series_->append(series, rows);
    part_.append(lines, rows);
  }

  void interrupt() override {
    if (series_) series_->sync();
    part_.file().sync();
  }

  void finish(const file::Attributes& attributes) override {
    std::vector<file::Hdf5Axis> axes;
    if (series_) axes.emplace_back(layout_.axis, layout_.axis_values);
    file::Hdf5TableWriter writer(target_, layout_.columns, axes);
    writer.keep(layout_.inputs);
    const std::size_t at_once =
        series_
            ? std::clamp<std::size_t>(most_bytes / (sizeof(double) * series_numbers_), 1, most_rows)
            : most_rows;
    file::Hdf5Block block;
    clear(block);
    std::size_t written = 0;
    const std::size_t read = part_.read([&](const RowReader& row) {
      add_row(row, block);
      if (++block.rows == at_once) written += write_block(writer, block, written);
    });
    if (block.rows > 0) written += write_block(writer, block, written);
    part_.check_complete(read);
    part_.check_complete(written);
    writer.finish(attributes);
    done_ = true;
    if (series_) series_->remove();
    part_.file().discard();
  }

 private:
  void clear(file::Hdf5Block& block) const {
    block.rows = 0;
    block.values.assign(layout_.columns.size(), {});
    block.texts.assign(layout_.columns.size(), {});
  }

  void add_row(const RowReader& row, file::Hdf5Block& block) const {
    std::size_t field = 0;
    for (std::size_t c = 0; c < layout_.columns.size(); ++c) {
      if (layout_.columns[c].kind == file::Hdf5Kind::series) continue;
      if (layout_.columns[c].kind == file::Hdf5Kind::text) {
        block.texts[c].push_back(row.text(field++));
      } else {
        block.values[c].push_back(row.number(field++));
      }
    }
  }

  // Writes the block's rows; `first` is the index of the first one. Returns their number.
  std::size_t write_block(file::Hdf5TableWriter& writer, file::Hdf5Block& block,
                          std::size_t first) {
    if (series_) {
      series_->read(first, block.rows, numbers_);
      std::size_t offset = 0;
      for (std::size_t c = 0; c < layout_.columns.size(); ++c) {
        if (layout_.columns[c].kind != file::Hdf5Kind::series) continue;
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
    const std::size_t rows = block.rows;
    writer.append(block);
    clear(block);
    return rows;
  }

  std::string target_;
  CaseFileLayout layout_;
  CasePart part_;
  std::size_t series_numbers_ = 0;  // of each case
  std::unique_ptr<SeriesPart> series_;
  std::vector<double> numbers_;
  bool done_ = false;
};

}  // namespace

std::unique_ptr<CaseFile> open_case_file_hdf5(const std::string& target, CaseFileLayout layout,
                                              const std::string& plan, bool resume) {
  file::require_hdf5(target);  // fails before any case is run
  return std::make_unique<Hdf5Cases>(target, std::move(layout), plan, resume);
}

}  // namespace bbsim::sweep
