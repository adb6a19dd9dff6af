// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// CSV: reads a table back and compares it, and checks the quoting of a sweep's rows.
#include <sys/mman.h>
#include <unistd.h>

#include <bit>
#include <charconv>
#include <string>
#include <vector>

#include "base/number_text.hpp"
#include "file/csv_fields.hpp"
#include "file/table.hpp"
#include "fuzz.hpp"
#include "record/compare.hpp"
#include "results/result.hpp"

namespace {

using namespace bbsim_fuzz;
using bbsim::number_text;
namespace file = bbsim::file;
namespace record = bbsim::record;

// A named file in memory, so that the disk does not limit the speed.
class NamedMemory {
 public:
  explicit NamedMemory(std::string_view content)
      : descriptor_(memfd_create("fuzz.csv", MFD_CLOEXEC)) {
    must(descriptor_ >= 0);
    must(write(descriptor_, content.data(), content.size()) ==
         static_cast<ssize_t>(content.size()));
  }
  ~NamedMemory() { close(descriptor_); }
  NamedMemory(const NamedMemory&) = delete;
  NamedMemory& operator=(const NamedMemory&) = delete;

  [[nodiscard]] std::string name() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

// The text of a number reads back to the same bits.
void must_round_trip(double number) {
  const std::string text = number_text(number);
  double back = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), back);
  must(result.ec == std::errc{} && result.ptr == text.data() + text.size());
  must(number != number
           ? back != back
           : std::bit_cast<std::uint64_t>(back) == std::bit_cast<std::uint64_t>(number));
}

void must_be_like_itself(const file::Table& table) {
  must(!table.columns.empty());
  for (const file::Column& column : table.columns) {
    must(column.numbers.size() == table.rows);
    for (const double number : column.numbers) must_round_trip(number);
  }
  const record::Comparison comparison = record::compare(table, table);
  must(comparison.alike());
  must(!record::to_text(comparison, "a", "b", {}).empty());
}

// A log has equally many numbers in each column and increasing times.
void must_be_a_log(const std::string& name) {
  const bbsim::results::Result log =
      bbsim::results::read_log(name, {{"x=-2*x+1:mm", "y=y"}, {}, "", "start", "-1"});
  for (const auto& column : log.columns) must(column.numbers.size() == log.rows);
  const auto* t = log.find("t");
  must(t != nullptr);
  for (std::size_t i = 1; i < log.rows; ++i) must(t->numbers[i] >= t->numbers[i - 1]);
}

// The fields of a line are unchanged after they are written as a row and read back.
void must_split_again(std::string_view line) {
  std::vector<std::string> fields, again;
  if (!file::split_fields(line, fields)) return;
  std::string written;
  for (const std::string& field : fields) {
    if (&field != fields.data()) written += ',';
    file::append_text(written, field);
  }
  must(file::split_fields(written, again));
  for (std::string& field : fields) {  // a row is one line: line breaks become spaces
    for (char& c : field) {
      if (c == '\n' || c == '\r') c = ' ';
    }
  }
  must(again == fields);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = text_of(data, size);
  may_refuse([&] { must_be_like_itself(file::read_table(NamedMemory(text).name())); });
  may_refuse([&] {
    must_be_like_itself(file::read_table(NamedMemory(text).name(), {{}, {"t", "x"}}));
  });
  may_refuse([&] { must_be_a_log(NamedMemory(text).name()); });
  for (std::string_view rest = text; !rest.empty();) must_split_again(take_line(rest));
  return 0;
}
