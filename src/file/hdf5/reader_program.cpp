// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim-hdf5-reader ROWS_A_BLOCK MOST_ROWS FILE...: prints the tables of HDF5 files, one after the
// other, in the format of table_text.hpp. If a file cannot be read, writes the reason to standard
// error and exits with code 1.
//
// bbsim runs this program as a separate process, because a damaged file may crash the HDF5 library
// or make it loop forever. Memory, and time without progress, are therefore bounded.
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/quoted.hpp"
#include "file/descriptor.hpp"
#include "file/hdf5/reader.hpp"
#include "file/hdf5/table_text.hpp"

namespace bbsim::hdf5 {
namespace {

using Json = nlohmann::ordered_json;

// Processor time without progress after which HDF5 counts as stuck: `patience`, plus a second per
// bytes_a_second of the file. Time spent waiting for a disk does not count.
constexpr rlim_t patience = 2;  // s
constexpr rlim_t bytes_a_second = rlim_t{1} << 27U;
// Memory that HDF5 may use for a file, in addition to four times the file's size.
constexpr rlim_t most_memory = rlim_t{1} << 30U;

constexpr std::size_t numbers_at_once = 32768;  // 256 KiB
constexpr std::size_t texts_at_once = 1024;

// Ends the process by SIGPROF unless it is set again in time.
class Timer {
 public:
  void allow_for(rlim_t bytes) {
    seconds_ = std::max(seconds_, static_cast<time_t>(patience + bytes / bytes_a_second));
    set();
  }
  void set() const {
    const itimerval timer{{0, 0}, {seconds_, 0}};
    setitimer(ITIMER_PROF, &timer, nullptr);
  }

 private:
  time_t seconds_ = patience;
};
Timer timer;

void prepare() {
  // No core dumps: after a crash, the file is at fault, not this program.
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  prctl(PR_SET_DUMPABLE, 0);
  // Ctrl-C reaches all processes of the terminal; bbsim handles it and ends this process.
  for (const int one : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) std::signal(one, SIG_IGN);
  keep_errors_to_ourselves();
}

rlim_t memory_in_use() {
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

rlim_t size_of(const char* path) {
  struct stat status {};
  return stat(path, &status) == 0 ? static_cast<rlim_t>(status.st_size) : 0;
}

// Makes larger allocations fail, which a damaged file may cause.
void limit_memory(rlim_t file_size) {
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  const rlim_t wanted = memory_in_use() + most_memory + 4 * std::min(file_size, RLIM_INFINITY / 8);
  limit.rlim_cur = std::min(wanted, limit.rlim_max);
  setrlimit(RLIMIT_AS, &limit);
}

void print(std::string_view bytes) {
  if (file::write_all(STDOUT_FILENO, bytes) != 0) _exit(0);  // bbsim reads no more
  timer.set();
}

const char* kind_text(bbsim_hdf5_kind kind) {
  return kind == BBSIM_HDF5_TEXT     ? text_kind
         : kind == BBSIM_HDF5_SERIES ? series_kind
                                     : number_kind;
}

Json described(const DatasetInfo& info) {
  return {{"name", info.name},
          {"unit", info.unit},
          {"meaning", info.description},
          {"kind", kind_text(info.kind)},
          {"width", info.width}};
}

// The shortest text that reads back as the same number.
std::string real_text(double number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

Json described(const std::string& name, const Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return {{"name", name}, {"text", *text}};
  if (const auto* real = std::get_if<double>(&value)) {
    return {{"name", name}, {"real", real_text(*real)}};  // JSON has no infinity
  }
  return {{"name", name}, {"integer", std::get<std::int64_t>(value)}};
}

class Table {
 public:
  explicit Table(const char* path) : reader_(path, [] { timer.set(); }) {
    for (std::size_t d = 0; d < reader_.root_datasets(); ++d) {
      (reader_.info(d).kind == BBSIM_HDF5_AXIS ? axes_ : columns_).push_back(d);
    }
    check_rows();
  }

  void print_head() const {
    Json head{{table_key, table_version}, {"rows", rows()}};
    for (const char* list : {"columns", "axes", "attributes", "inputs"}) {
      head[list] = Json::array();
    }
    for (const std::size_t d : columns_) head["columns"].push_back(described(reader_.info(d)));
    for (const std::size_t d : axes_) head["axes"].push_back(described(reader_.info(d)));
    for (const auto& [name, value] : reader_.attributes()) {
      head["attributes"].push_back(described(name, value));
    }
    for (const InputInfo& input : reader_.inputs()) {
      Json names = Json::array();
      for (std::size_t c = 0; c < input.count; ++c) {
        names.push_back(reader_.info(input.first + c).name);
      }
      head["inputs"].push_back(
          {{"file", input.file}, {"rows", rows_of(input)}, {"columns", std::move(names)}});
    }
    print(head.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n');
  }

  void print_axes() {
    for (const std::size_t d : axes_) print_rows(d, 0, reader_.info(d).rows);
  }

  void print_blocks(std::size_t rows_a_block, std::size_t most_rows) {
    const std::size_t last = std::min(rows(), most_rows);
    for (std::size_t first = 0; first < last; first += std::min(rows_a_block, last - first)) {
      for (const std::size_t d : columns_) {
        print_rows(d, first, std::min(rows_a_block, last - first));
      }
    }
  }

  void print_inputs() {
    for (const InputInfo& input : reader_.inputs()) {
      for (std::size_t d = input.first; d < input.first + input.count; ++d) {
        const DatasetInfo& info = reader_.info(d);
        if (info.kind != BBSIM_HDF5_NUMBER || info.rows != rows_of(input)) {
          throw Failure("input table " + shown(input.file) + " is not a table of numbers");
        }
        print_rows(d, 0, info.rows);
      }
    }
  }

 private:
  void check_rows() const {
    for (const std::size_t d : columns_) {
      const DatasetInfo& info = reader_.info(d);
      if (info.rows == rows()) continue;
      throw Failure("dataset " + shown(info.name) + " has " + std::to_string(info.rows) +
                    " rows, " + shown(reader_.info(columns_[0]).name) + " has " +
                    std::to_string(rows()) + "; all must have the same number");
    }
  }

  [[nodiscard]] std::size_t rows() const {
    return columns_.empty() ? 0 : reader_.info(columns_[0]).rows;
  }
  [[nodiscard]] std::size_t rows_of(const InputInfo& input) const {
    return input.count == 0 ? 0 : reader_.info(input.first).rows;
  }

  void print_rows(std::size_t dataset, std::size_t first, std::size_t rows) {
    const DatasetInfo& info = reader_.info(dataset);
    const bool is_text = info.kind == BBSIM_HDF5_TEXT;
    const std::size_t width = info.kind == BBSIM_HDF5_SERIES ? info.width : 1;
    if (width == 0) return;
    const std::size_t at_once =
        is_text ? texts_at_once : std::max<std::size_t>(1, numbers_at_once / width);
    for (std::size_t done = 0; done < rows; done += at_once) {
      const std::size_t now = std::min(at_once, rows - done);
      if (is_text) {
        print_texts(reader_.read_texts(dataset, first + done, now));
        continue;
      }
      numbers_.resize(now * width);
      reader_.read_numbers(dataset, first + done, now, numbers_.data());
      print({reinterpret_cast<const char*>(numbers_.data()), numbers_.size() * sizeof(double)});
    }
  }

  static void print_texts(const std::vector<std::string>& texts) {
    std::string bytes;
    for (const std::string& text : texts) {
      if (text.size() > longest_text) {
        throw Failure("it holds a text of " + std::to_string(text.size()) +
                      " bytes; allowed: " + std::to_string(longest_text));
      }
      const std::uint64_t size = text.size();
      bytes.append(reinterpret_cast<const char*>(&size), sizeof size).append(text);
    }
    print(bytes);
  }

  Reader reader_;
  std::vector<std::size_t> columns_, axes_;
  std::vector<double> numbers_;
};

void print_table(const char* path, std::size_t rows_a_block, std::size_t most_rows) {
  const rlim_t bytes = size_of(path);
  limit_memory(bytes);
  timer.allow_for(bytes);
  Table table(path);
  table.print_head();
  table.print_axes();
  table.print_blocks(rows_a_block, most_rows);
  table.print_inputs();
}

std::size_t number_of(std::string_view text) {
  std::size_t number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || stop != text.data() + text.size() || number == 0) {
    throw Failure("found " + shown(text) + "; allowed: a number of rows, 1 or more");
  }
  return number;
}

// hdf5_process.cpp turns the text into an error message.
[[noreturn]] void give_up(std::string_view why) {
  [[maybe_unused]] const int ignored = file::write_all(STDERR_FILENO, why);
  _exit(1);
}

}  // namespace
}  // namespace bbsim::hdf5

int main(int argc, char** argv) {
  using namespace bbsim::hdf5;
  constexpr const char* no_memory = "there is not enough memory for the size that it declares";
  prepare();
  try {
    if (argc < 4) throw Failure("allowed: ROWS_A_BLOCK MOST_ROWS FILE...");
    const std::size_t rows_a_block = number_of(argv[1]), most_rows = number_of(argv[2]);
    for (int i = 3; i < argc; ++i) print_table(argv[i], rows_a_block, most_rows);
  } catch (const std::bad_alloc&) {
    give_up(no_memory);
  } catch (const std::length_error&) {
    give_up(no_memory);
  } catch (const std::exception& failure) {
    give_up(failure.what());
  }
  _exit(0);  // skips HDF5's cleanup at exit, which a damaged file may make crash
}
