// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/case_rows.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

#include "base/error.hpp"
#include "file/case_text.hpp"
#include "file/descriptor.hpp"

namespace bbsim::sweep {
namespace {

constexpr std::size_t at_once = 262144;                              // bytes
constexpr std::size_t longest_line = std::size_t{64} * 1024 * 1024;  // bytes: no row is that long

// std::to_chars writes nan and inf, and from_chars reads them.
template <class Number>
bool is_number(std::string_view text, Number& value) {
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc{} && result.ptr == end;
}

// Returns the end of the field that begins at `start`: the index of the comma, or the length of the
// line. A quoted field ends after its closing quote. Returns npos if the quote is not closed or
// text follows it.
std::size_t end_of_field(std::string_view line, std::size_t start) {
  if (start >= line.size() || line[start] != '"')
    return std::min(line.find(',', start), line.size());
  for (std::size_t i = start + 1; i < line.size(); ++i) {
    if (line[i] != '"') continue;
    if (i + 1 < line.size() && line[i + 1] == '"') {
      ++i;
      continue;
    }
    return i + 1 == line.size() || line[i + 1] == ',' ? i + 1 : std::string_view::npos;
  }
  return std::string_view::npos;
}

std::string fields_found(std::size_t found, std::size_t expected) {
  return std::to_string(found) + (found == 1 ? " field" : " fields") + " where " +
         std::to_string(expected) + " belong";
}

}  // namespace

void blame(Blame whose, const std::string& message) {
  if (whose == Blame::input) throw InputError(message);
  throw OutputError(message);
}

PartLines::PartLines(int descriptor, std::string name, Blame whose)
    : descriptor_(descriptor), name_(std::move(name)), whose_(whose), buffer_(at_once) {}

// Appends more bytes to the buffer. Returns false at the end of the file.
bool PartLines::fill() {
  if (begin_ > 0) std::memmove(buffer_.data(), buffer_.data() + begin_, size_);
  begin_ = 0;
  if (size_ == buffer_.size()) {
    if (size_ >= longest_line) blame(whose_, "cannot read " + name_ + ": a line without end");
    buffer_.resize(2 * size_);
  }
  const ssize_t got =
      file::read_at(descriptor_, buffer_.data() + size_, buffer_.size() - size_, place_);
  if (got < 0) blame(whose_, "cannot read " + name_ + ": " + file::error_text(errno));
  size_ += static_cast<std::size_t>(got);
  place_ += got;
  return got > 0;
}

bool PartLines::next(std::string_view& line) {
  std::size_t looked_at = 0;
  for (;;) {
    const char* const from = buffer_.data() + begin_;
    const void* const found = std::memchr(from + looked_at, '\n', size_ - looked_at);
    if (found != nullptr) {
      const auto length = static_cast<std::size_t>(static_cast<const char*>(found) - from);
      line = {from, length};
      begin_ += length + 1;
      size_ -= length + 1;
      end_ += static_cast<off_t>(length + 1);
      whole_ = true;
      return true;
    }
    looked_at = size_;
    if (fill()) continue;
    whole_ = false;
    line = {buffer_.data(), size_};
    end_ += static_cast<off_t>(size_);
    return std::exchange(size_, 0) > 0;
  }
}

RowReader::RowReader(std::vector<Field> fields)
    : fields_(std::move(fields)), cells_(fields_.size()), numbers_(fields_.size()) {}

RowReader::RowReader(const std::vector<file::Hdf5Column>& columns)
    : RowReader([&columns] {
        std::vector<Field> fields{Field::whole_number};
        for (std::size_t c = 1; c < columns.size(); ++c) {
          if (columns[c].kind == file::Hdf5Kind::series) continue;
          fields.push_back(columns[c].kind == file::Hdf5Kind::text ? Field::text : Field::number);
        }
        return fields;
      }()) {}

RowReader::RowReader(const std::string& header)
    : RowReader([&header] {
        std::vector<std::string> names;
        static_cast<void>(file::split_fields(header, names));
        const auto status = std::find(names.begin(), names.end(), "status");
        auto texts = status;  // the last text
        if (status != names.end() && status + 1 != names.end() && status[1] == "reason") ++texts;
        std::vector<Field> fields{Field::whole_number};
        for (auto name = names.begin() + 1; name != names.end(); ++name) {
          fields.push_back(name > texts ? Field::number : Field::text);
        }
        return fields;
      }()) {}

std::string RowReader::read(std::string_view line) {
  if (line.find('\0') != std::string_view::npos)
    return "zero bytes";  // a disk page that was never written
  std::size_t count = 0;
  for (std::size_t start = 0;; ++count) {
    const std::size_t end = end_of_field(line, start);
    if (end == std::string_view::npos) return "a quote that is not closed";
    if (count < cells_.size()) cells_[count] = line.substr(start, end - start);
    if (end == line.size()) break;
    start = end + 1;
  }
  ++count;
  if (!is_number(cells_[0], case_number_))
    return "a row that does not begin with the number of a case";
  if (count != cells_.size()) return fields_found(count, cells_.size());
  for (std::size_t i = 1; i < cells_.size(); ++i) {
    if (fields_[i] == Field::number && !is_number(cells_[i], numbers_[i])) {
      return "something other than a number in field " + std::to_string(i + 1);
    }
  }
  numbers_[0] = static_cast<double>(case_number_);
  return "";
}

std::string RowReader::text(std::size_t field) const {
  std::string_view cell = cells_[field];
  if (!cell.starts_with('"')) return std::string(cell);
  std::string text;
  cell = cell.substr(1, cell.size() - 2);
  for (std::size_t i = 0; i < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"') ++i;  // a doubled quote stands for one
  }
  return text;
}

void StatusCounts::add(std::size_t number, const std::string& status, std::string_view reason) {
  ++words[status];
  if (status != "done" && failed.size() < most_failed) {
    failed.push_back({number, status, std::string(reason)});
  }
  not_finite += status == "done" && !reason.empty() ? 1 : 0;
}

void StatusCounts::add_expected(std::size_t number, std::size_t which, bool holds) {
  if (unmet.size() <= which) unmet.resize(which + 1);
  if (holds) return;
  ++unmet[which];
  if (failed.size() < most_failed && (failed.empty() || failed.back().number != number)) {
    failed.push_back({number, "done", "not as expected"});
  }
}

void StatusCounts::add(const StatusCounts& others) {
  for (const auto& [word, count] : others.words) words[word] += count;
  not_finite += others.not_finite;
  unmet.resize(std::max(unmet.size(), others.unmet.size()));
  for (std::size_t i = 0; i < others.unmet.size(); ++i) unmet[i] += others.unmet[i];
  const std::size_t more = std::min(others.failed.size(), most_failed - failed.size());
  failed.insert(failed.end(), others.failed.begin(),
                others.failed.begin() + static_cast<std::ptrdiff_t>(more));
}

std::size_t StatusCounts::early() const {
  std::size_t early = 0;
  for (const auto& [word, count] : words) early += word == "done" ? 0 : count;
  return early;
}

}  // namespace bbsim::sweep
