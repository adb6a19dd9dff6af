// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads tables from the output of the HDF5 reader process (hdf5/table_text.hpp).
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/quoted.hpp"
#include "file/descriptor.hpp"
#include "file/hdf5/table_text.hpp"
#include "file/hdf5_process.hpp"
#include "file/hdf5_table.hpp"

namespace bbsim::file {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* unexpected =
    "the HDF5 reader printed something unexpected: the file is damaged";
constexpr std::size_t numbers_at_once = 32768;  // read before allocating more

[[noreturn]] void refuse_file(const std::string& file, std::string_view reason) {
  throw InputError("cannot read " + shown(file, uncut) + ": " + std::string(reason));
}

// Runs `action`. Turns its exceptions into an InputError about the file.
template <class Action>
auto guarded(const std::string& file, Action action) {
  try {
    return action();
  } catch (const std::bad_alloc&) {
    refuse_file(file, "there is not enough memory for its content");
  } catch (const std::length_error&) {
    refuse_file(file, "there is not enough memory for its content");
  } catch (const Hdf5Trouble& trouble) {
    refuse_file(file, trouble.what());
  } catch (const Json::exception&) {
    refuse_file(file, unexpected);
  }
}

void check_regular(const std::string& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0 || access(file.c_str(), R_OK) != 0) {
    refuse_file(file, error_text(errno));
  }
  if (!S_ISREG(status.st_mode)) refuse_file(file, "it is not a regular file");
}

Hdf5Kind kind_named(const std::string& text) {
  return text == hdf5::text_kind     ? Hdf5Kind::text
         : text == hdf5::series_kind ? Hdf5Kind::series
                                     : Hdf5Kind::number;
}

// Refuses other numbers, because their conversion is undefined if they are out of range.
std::size_t count_of(const Json& json) {
  if (!json.is_number_unsigned()) throw Hdf5Trouble(unexpected);
  return json.get<std::size_t>();
}

Hdf5Column column_of(const Json& json) {
  return {json.at("name"), json.at("unit"), json.at("meaning"), kind_named(json.at("kind")),
          count_of(json.at("width"))};
}

AttributeValue value_of(const Json& json) {
  if (json.contains("text")) return json["text"].get<std::string>();
  if (json.contains("integer")) {
    if (!json["integer"].is_number_integer()) throw Hdf5Trouble(unexpected);
    return json["integer"].get<std::int64_t>();
  }
  const std::string text = json.at("real");
  double number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

std::size_t product(std::size_t rows, std::size_t width) {
  std::size_t result = 0;
  if (__builtin_mul_overflow(rows, width, &result)) throw std::length_error("");
  return result;
}

}  // namespace

Hdf5TableReader::Hdf5TableReader(const std::string& file, const Hdf5Rows& rows)
    : Hdf5TableReader(Hdf5TableReaders({file}, rows).next()) {}

Hdf5TableReader::Hdf5TableReader(std::string file, const Hdf5Rows& rows,
                                 std::shared_ptr<Hdf5Process> process)
    : file_(std::move(file)), a_block_(rows.a_block), process_(std::move(process)) {
  guarded(file_, [this] { read_head(); });
  if (columns_.empty()) fail("it holds no column at its root");
  left_ = std::min(rows_, rows.most);
  for (Hdf5Axis& axis : axes_) {
    guarded(file_, [&] { take_numbers(std::exchange(axis.first.width, 1), axis.second); });
  }
}

bool Hdf5TableReader::read(Hdf5Block& into) {
  into.rows = std::min(a_block_, left_);
  into.values.resize(columns_.size());
  into.texts.resize(columns_.size());
  guarded(file_, [&] {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const Hdf5Column& column = columns_[c];
      const bool is_text = column.kind == Hdf5Kind::text;
      const std::size_t width = column.kind == Hdf5Kind::series ? column.width : 1;
      take_texts(is_text ? into.rows : 0, into.texts[c]);
      take_numbers(is_text ? 0 : product(into.rows, width), into.values[c]);
    }
  });
  left_ -= into.rows;
  return into.rows > 0;
}

std::vector<InputTable> Hdf5TableReader::read_inputs() {
  Hdf5Block skipped;
  while (read(skipped)) {
  }
  std::vector<InputTable> inputs;
  for (const InputHead& head : inputs_) {
    TableData table{head.columns, std::vector<std::vector<double>>(head.columns.size())};
    for (std::vector<double>& column : table.columns) {
      guarded(file_, [&] { take_numbers(head.rows, column); });
    }
    inputs.push_back({head.file, std::make_shared<TableData>(std::move(table))});
  }
  return inputs;
}

void Hdf5TableReader::fail(std::string_view reason) const {
  refuse_file(file_, reason);
}

void Hdf5TableReader::read_head() {
  const Json head = parse_json(process_->line());
  const bool is_table = head.is_object() && head.contains(hdf5::table_key);
  if (!is_table || count_of(head[hdf5::table_key]) != hdf5::table_version) {
    throw Hdf5Trouble(
        "the HDF5 reader belongs to another version of bbsim; install the two together");
  }
  rows_ = count_of(head.at("rows"));
  for (const Json& column : head.at("columns")) columns_.push_back(column_of(column));
  for (const Json& axis : head.at("axes")) {
    axes_.emplace_back(column_of(axis), std::vector<double>());
  }
  for (const Json& attribute : head.at("attributes")) {
    attributes_.emplace_back(attribute.at("name").get<std::string>(), value_of(attribute));
  }
  for (const Json& input : head.at("inputs")) {
    inputs_.push_back({input.at("file"), input.at("columns"), count_of(input.at("rows"))});
  }
}

void Hdf5TableReader::take_numbers(std::size_t count, std::vector<double>& numbers) {
  numbers.clear();
  numbers.reserve(count);
  while (numbers.size() < count) {
    const std::size_t place = numbers.size();
    const std::size_t now = std::min(numbers_at_once, count - place);
    numbers.resize(place + now);
    process_->take(&numbers[place], now * sizeof(double));
  }
}

void Hdf5TableReader::take_texts(std::size_t count, std::vector<std::string>& texts) {
  texts.clear();
  while (texts.size() < count) {
    std::uint64_t size = 0;
    process_->take(&size, sizeof size);
    if (size > hdf5::longest_text) throw Hdf5Trouble("the HDF5 reader printed too long a text");
    std::string& text = texts.emplace_back(size, '\0');
    process_->take(text.data(), size);
  }
}

Hdf5TableReaders::Hdf5TableReaders(std::vector<std::string> files, const Hdf5Rows& rows)
    : files_(std::move(files)), rows_(rows) {
  for (const std::string& file : files_) check_regular(file);
  process_ =
      guarded(files_.front(), [this] { return std::make_shared<Hdf5Process>(files_, rows_); });
}

Hdf5TableReader Hdf5TableReaders::next() {
  return {files_.at(next_++), rows_, process_};
}

}  // namespace bbsim::file
