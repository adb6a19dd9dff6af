// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A sweep's results on their way into a file: an earlier run's cases are checked, conflicts
// refused, and nothing is discarded before the result is complete.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <vector>

#include "base/error.hpp"
#include "file/hdf5_table.hpp"
#include "support/folder.hpp"
#include "support/sweep_setup.hpp"
#include "sweep/case_file.hpp"

namespace bbsim_test::test_case_file {

using namespace bbsim::file;
using namespace bbsim::sweep;
using bbsim::InputError;
using bbsim::OutputError;
using Catch::Matchers::Contains;
using Counts = std::map<std::string, std::size_t, std::less<>>;

namespace {

const std::string plan = R"({"version": "1", "instruction_set": "avx2", "seed": 1})";
const std::string header = "case,gravity,solver.method,status,reason,end_time,end_x,expected\n";

// Whether all cases were collected. Calls `tell` with their number on the way.
bool finish(
    CaseFile& file, const bbsim::file::Attributes& attributes, std::size_t threads,
    const std::function<void(std::size_t)>& tell = [](std::size_t) {},
    const std::atomic<bool>& stop = false) {
  return file.finish(attributes, {threads, stop, tell});
}

// Cases 100 to 109 of a sweep over a number and a text.
struct Ten : Setup {
  explicit Ten(bool series = false)
      : Setup("configs/fig2a.yaml",
              {{"gravity", "linear:1:2:60"}, {"solver.method", "list:radau,bdf"}}, {}, {"end_x"}) {
    task.expectations = {
        bbsim::scenario::read_expectation("", "end_x < 0.106", family.read(plan.settings(0)))};
    task.expected = {0};
    layout.columns = {{"case", "1", ""},
                      {"gravity", "SI", ""},
                      {"solver.method", "", "", Hdf5Kind::text},
                      {"status", "", "", Hdf5Kind::text},
                      {"reason", "", "", Hdf5Kind::text},
                      {"end_time", "s", ""},
                      {"end_x", "m", ""},
                      {"expected", "1", ""}};
    layout.range = {100, 110};
    if (!series) return;
    layout.axis = {"t", "s", ""};
    layout.axis_values = {0, 1, 2};
    layout.columns.push_back({"x", "m", "", Hdf5Kind::series, 3});
    task.series = {bbsim::scenario::find_column("x")};
    task.series_rows = 3;
  }

  [[nodiscard]] std::unique_ptr<CaseFile> open(const std::string& target, bool resume = false,
                                               const std::string& with = test_case_file::plan) {
    return std::make_unique<CaseFile>(target, layout, task, with, resume);
  }

  // Appends cases first ... last - 1, in a block.
  void append(CaseFile& file, std::size_t first, std::size_t last) const {
    CaseResults results;
    results.first = first;
    results.resize(last - first, task);
    for (std::size_t i = 0; i < results.count; ++i) {
      const auto number = static_cast<double>(first + i);
      const bool fails = (first + i) % 4 == 0;
      results.values[2 * i] = number / 8;
      results.values[2 * i + 1] = static_cast<double>((first + i) % 2);
      results.numbers[2 * i] = fails ? 0.5 : 10;
      results.numbers[2 * i + 1] = fails ? NAN : number / 1000;
      if (fails) results.status[i] = {"failed", "so, and"};
      for (auto& column : results.series) {
        for (std::size_t k = 0; k < 3; ++k) column[3 * i + k] = number + 0.1 * double(k);
      }
    }
    file.prepare(results);
    file.append(results);
  }

  // Leaves a journal with a record for each case. Returns the places of the records, and their end.
  std::vector<std::size_t> leave_unfinished(const std::string& target, std::size_t last) {
    const auto file = open(target);
    std::vector<std::size_t> places;
    for (std::size_t number = 100; number < last; ++number) {
      places.push_back(std::filesystem::file_size(file->part()));
      append(*file, number, number + 1);
    }
    places.push_back(std::filesystem::file_size(file->part()));
    return places;
  }

  // Continues with the missing cases.
  KeptCases complete(const std::string& target) {
    const auto file = open(target, true);
    KeptCases kept = file->kept();
    if (kept.cases < 10) append(*file, 100 + kept.cases, 110);
    CHECK(finish(*file, {{"title", "t"}}, 2));
    return kept;
  }

  CaseFileLayout layout;
};

// A file to write, and the same one written at once.
struct FileBesideExpected {
  explicit FileBesideExpected(const std::string& ending)
      : target(folder / ("a" + ending)), expected(folder / ("expected" + ending)) {
    sweep.complete(expected);
  }
  [[nodiscard]] bool are_alike() const { return content_of(target) == content_of(expected); }

  Folder folder{};
  Ten sweep{};
  std::string target, expected;
};

std::string row(std::size_t number) {
  const std::string text = std::to_string(number);
  std::string gravity = std::to_string(static_cast<double>(number) / 8);
  gravity.erase(gravity.find_last_not_of("0.") + 1);
  const std::string end = number == 100 ? "0.1" : "0." + text;
  return text + ',' + gravity + (number % 2 == 0 ? ",radau" : ",bdf") +
         (number % 4 == 0 ? ",failed,\"so, and\",0.5,nan,0\n"
                          : ",done,,10," + end + (number < 106 ? ",1\n" : ",0\n"));
}

std::string rows(std::size_t first, std::size_t last) {
  std::string text;
  for (std::size_t number = first; number < last; ++number) text += row(number);
  return text;
}

std::string opening_fails(const std::string& target, bool resume = true,
                          const std::string& with = plan) {
  return message_of<InputError>([&] { static_cast<void>(Ten().open(target, resume, with)); });
}

std::string writing_fails(const std::string& target) {
  return message_of<OutputError>([&] { static_cast<void>(Ten().open(target, true)); });
}

}  // namespace

TEST_CASE("cases become a file, and a continued journal gives the same bytes") {
  const Folder folder;
  const std::string ending =
      GENERATE(std::string(".csv"), std::string(".h5"), std::string(".HDF5"));
  CAPTURE(ending);
  Ten sweep(ending != ".csv");
  const std::string whole = folder / ("a" + ending), target = folder / ("b" + ending);
  sweep.complete(whole);
  CHECK(folder.entries() == 1);
  if (ending == ".csv") {
    CHECK(content_of(whole) == header + rows(100, 110));
  } else {
    Hdf5TableReader reader(whole);
    Hdf5Block block;
    CHECK(reader.read(block));
    CHECK(block.rows == 10);
    CHECK(block.texts[4][4] == "so, and");
    CHECK(block.values[8][5] == 101.2);
  }

  sweep.leave_unfinished(target, 107);
  CHECK(folder.entries() == 2);
  const KeptCases kept = sweep.complete(target);
  CHECK(kept.cases == 7);
  CHECK(kept.trouble.empty());
  CHECK(kept.statuses.words == Counts{{"done", 5}, {"failed", 2}});
  CHECK(kept.statuses.unmet == std::vector<std::size_t>{3});
  CHECK(kept.statuses.failed.size() == 3);
  CHECK(folder.entries() == 2);
  const bool alike = content_of(whole) == content_of(target);
  CHECK(alike);
}

TEST_CASE("a journal is cut at the first invalid record, and this is reported") {
  const Folder folder;
  const std::string target = folder / "a.csv", part = target + ".part";
  Ten sweep;
  const std::vector<std::size_t> places = sweep.leave_unfinished(target, 108);
  const std::string whole = content_of(part);
  const std::size_t at = places[3], size = places[4] - at;  // of case 103
  const auto resumed = [&](const std::string& content) {
    folder.put("a.csv.part", content);
    KeptCases kept = sweep.complete(target);
    CHECK(content_of(target) == header + rows(100, 110));
    CHECK(folder.entries() == 1);
    return kept;
  };
  const auto kept_of = [&](const std::string& content) {
    folder.put("a.csv.part", content);
    return sweep.open(target, true)->kept();
  };
  const auto is_cut_at_103 = [&](const std::string& content) {
    const KeptCases kept = resumed(content);
    CHECK(kept.cases == 3);
    CHECK(kept.trouble ==
          part + ": the record of case 103 is not as it was written; continuing from case 103");
  };
  const auto changed = [&](std::size_t place, std::size_t length, const std::string& by) {
    return std::string(whole).replace(place, length, by);
  };

  SECTION("a deleted, a repeated and a swapped record") {
    is_cut_at_103(changed(at, size, ""));
    is_cut_at_103(changed(at, 0, whole.substr(places[2], at - places[2])));
    is_cut_at_103(changed(at, size, whole.substr(places[4], places[5] - places[4])));
  }
  SECTION("zeros") {
    is_cut_at_103(changed(at, 24, std::string(24, '\0')));
    is_cut_at_103(changed(at + 40, 8, std::string(8, '\0')));
    is_cut_at_103(whole.substr(0, at) + std::string(4096, '\0'));
  }
  SECTION("any changed bit is found") {
    for (std::size_t place = at; place < places[4]; ++place) {
      std::string content = whole;
      content[place] = static_cast<char>(content[place] ^ 16);
      CHECK(kept_of(content).cases == 3);
    }
  }
  SECTION("more records than cases") {
    std::filesystem::remove(part);
    sweep.leave_unfinished(target, 110);
    const std::string full = content_of(part);
    const KeptCases kept = resumed(full + full.substr(places[7], places[8] - places[7]));
    CHECK(kept.cases == 10);
    CHECK_THAT(kept.trouble, Contains("the record of case 110"));
  }
  SECTION("a plan that never reached the disk") {
    const KeptCases kept = resumed(std::string(4096, '\0'));
    CHECK(kept.cases == 0);
    CHECK_THAT(kept.trouble, Contains("the plan is not as it was written"));
  }
  SECTION("the state after a kill is valid") {
    for (std::size_t length = 0; length < whole.size(); ++length) {
      const KeptCases kept = kept_of(whole.substr(0, length));
      CHECK(kept.trouble.empty());
      const auto records = std::ranges::upper_bound(places, length) - places.begin();
      CHECK(static_cast<std::ptrdiff_t>(kept.cases) == std::max<std::ptrdiff_t>(records, 1) - 1);
    }
    CHECK(resumed(whole.substr(0, whole.size() - 1)).cases == 7);
  }
}

TEST_CASE("a file with too few cases is not completed, and its journal stays") {
  const Folder folder;
  const std::string target = folder / ("a" + GENERATE(std::string(".csv"), std::string(".h5")));
  Ten sweep;
  {
    const auto file = sweep.open(target);
    sweep.append(*file, 100, 108);
    CHECK_THAT(message_of<OutputError>([&] { finish(*file, {}, 1); }),
               Contains("it has 8 cases of 10"));
  }
  CHECK_FALSE(std::filesystem::exists(target));
  {
    const auto file = sweep.open(target, true);
    sweep.append(*file, 108, 110);
    REQUIRE(truncate((target + ".part").c_str(), 400) == 0);  // by another process
    CHECK_THAT(message_of<OutputError>([&] { finish(*file, {}, 2); }), Contains("with --resume"));
  }
  CHECK(folder.entries() == 1);
  CHECK(std::filesystem::exists(target + ".part"));
}

TEST_CASE("collecting tells how far it is, and stops on request with the journal whole") {
  FileBesideExpected files(GENERATE(std::string(".csv"), std::string(".h5")));
  const std::string& target = files.target;
  Ten& sweep = files.sweep;
  {
    const auto file = sweep.open(target);
    sweep.append(*file, 100, 107);
    sweep.append(*file, 107, 110);
    std::atomic<bool> stop = false;
    std::vector<std::size_t> told;
    CHECK_FALSE(finish(
        *file, {{"title", "t"}}, 1,
        [&](std::size_t cases) {
          told.push_back(cases);
          stop = true;
        },
        stop));
    CHECK(told == std::vector<std::size_t>{7});
  }
  CHECK_FALSE(std::filesystem::exists(target));
  const auto file = sweep.open(target, true);
  CHECK(file->kept().cases == 10);
  CHECK(finish(*file, {{"title", "t"}}, 1));
  CHECK(files.are_alike());
}

TEST_CASE("a journal that loses its name is neither lost nor mistaken for another") {
  FileBesideExpected files(GENERATE(std::string(".csv"), std::string(".h5")));
  const std::string& target = files.target;
  Ten& sweep = files.sweep;
  const auto file = sweep.open(target);
  sweep.append(*file, 100, 110);
  CHECK(file->part() == target + ".part");
  REQUIRE(unlink((target + ".part").c_str()) == 0);
  CHECK(file->part().empty());
  SECTION("removed") {
    CHECK(finish(*file, {{"title", "t"}}, 1));
  }
  SECTION("replaced") {
    std::ofstream(target + ".part") << "somebody else's";
    CHECK(finish(*file, {{"title", "t"}}, 1));
    CHECK(content_of(target + ".part") == "somebody else's");
  }
  CHECK(files.are_alike());
}

TEST_CASE("nothing is written through a link or special file in its place") {
  const Folder folder;
  const std::string precious = folder.put("precious", "precious");
  const std::string name = GENERATE(std::string(".part"), std::string(".plan"));
  const std::string target = folder / "a.csv";
  CAPTURE(name);
  SECTION("a symbolic link") {
    std::filesystem::create_symlink("precious", target + name);
    CHECK_THAT(writing_fails(target), Contains(target + name + ": it is a symbolic link"));
  }
  SECTION("a hard link") {
    REQUIRE(link(precious.c_str(), (target + name).c_str()) == 0);
    CHECK_THAT(writing_fails(target), Contains("a hard link"));
  }
  SECTION("a FIFO") {
    REQUIRE(mkfifo((target + name).c_str(), 0600) == 0);
    CHECK_THAT(writing_fails(target), Contains("not a regular file"));
  }
  SECTION("another user's file") {
    folder.put("a.csv" + name, "");
    if (chown((target + name).c_str(), 65534, 65534) != 0) return;  // only root may do this
    CHECK_THAT(writing_fails(target), Contains("another user"));
  }
  SECTION("a folder") {
    std::filesystem::create_directory(target + name);
    CHECK_FALSE(writing_fails(target).empty());
  }
  CHECK(content_of(precious) == "precious");
  CHECK(folder.entries() == 2);
}

TEST_CASE("a journal is continued only with the same plan, and differences are reported") {
  const Folder folder;
  const std::string target = folder / "a.csv";
  Ten().leave_unfinished(target, 103);
  const std::string content = content_of(target + ".part");
  const auto differs = [&](const std::string& other) { return opening_fails(target, true, other); };
  CHECK_THAT(opening_fails(target, false), Contains("add --resume"));
  CHECK_THAT(differs(R"({"version": "1", "instruction_set": "avx2", "seed": 2})"),
             Contains("of another sweep than this one") && Contains("in its seed;"));
  CHECK_THAT(differs(R"({"version": "1", "instruction_set": "avx512", "seed": 1})"),
             Contains("begun with the instruction set avx2, and this is avx512") &&
                 Contains("BBSIM_SIMD=avx2"));
  CHECK_THAT(differs(R"({"instruction_set": "avx512", "seed": 1, "vary": []})"),
             Contains("in its version, vary;"));
  CHECK(content_of(target + ".part") == content);
  folder.put("a.csv.part", std::string(content).replace(40, 1, "x"));
  CHECK_THAT(differs(plan), Contains("which is not a plan of bbsim"));
}

TEST_CASE("a part that is no journal is refused, and stays") {
  const Folder folder;
  const auto [content, found] = GENERATE(
      std::pair<std::string, std::string>{header + rows(100, 103), "CSV rows, as bbsim 0.3.0"},
      std::pair<std::string, std::string>{"my own text\n", "no journal of a sweep"},
      std::pair<std::string, std::string>{"m", "no journal of a sweep"});
  const bool resume = GENERATE(true, false);
  folder.put("a.csv.part", content);
  CHECK_THAT(opening_fails(folder / "a.csv", resume),
             Contains("a.csv.part: found " + found) && Contains("allowed: "));
  CHECK(content_of(folder / "a.csv.part") == content);
}

TEST_CASE("a journal belongs to one process at a time") {
  const Folder folder;
  Ten sweep;
  const auto file = sweep.open(folder / "a.csv");
  sweep.append(*file, 100, 101);
  const std::string content = content_of(file->part());
  CHECK_THAT(opening_fails(folder / "a.csv"), Contains("another bbsim is writing to it"));
  CHECK(content_of(file->part()) == content);
}

TEST_CASE("a sweep's file keeps the permissions of the file that it replaces") {
  const Folder folder;
  const std::string target = folder.put("a.csv", "old");
  REQUIRE(chmod(target.c_str(), 0600) == 0);
  Ten sweep;
  sweep.layout.is_shard = true;
  const auto file = sweep.open(target);
  CHECK(permissions_of(target + ".part") == 0600);
  sweep.append(*file, 100, 110);
  REQUIRE(chmod(target.c_str(), 0640) == 0);
  CHECK(finish(*file, {}, 1));
  CHECK(content_of(target) == header + rows(100, 110));
  CHECK(permissions_of(target) == 0640);
  CHECK(permissions_of(target + ".plan") == 0640);
}

TEST_CASE("an output that cannot be written is reported before any case runs") {
  const Folder folder;
  std::filesystem::create_symlink("loop.csv", folder / "loop.csv");
  folder.put("file", "");
  CHECK_THAT(writing_fails(folder / "loop.csv"), Contains("too many levels of symbolic links"));
  CHECK_THAT(writing_fails(folder / "none/a.csv"), Contains("no such file or directory"));
  CHECK_THAT(writing_fails(folder / "file/a.csv"), Contains("not a directory"));
  for (const std::size_t length : {252, 248}) {  // the output's name, that of its journal
    const std::string name = std::string(length, 'n') + ".csv";
    CHECK_THAT(writing_fails(folder / name), Contains("file name too long"));
  }
  CHECK(folder.entries() == 2);
}

TEST_CASE("a CSV shard keeps its plan beside it, and a whole sweep in its place does not") {
  const Folder folder;
  Ten sweep;
  sweep.layout.is_shard = true;
  sweep.complete(folder / "a.csv");
  CHECK(folder.entries() == 2);
  CHECK(content_of(folder / "a.csv.plan") == plan);
  sweep.layout.is_shard = false;
  sweep.complete(folder / "a.csv");
  CHECK(folder.entries() == 1);
}

TEST_CASE("a journal without cases is removed with its sweep") {
  const Folder folder;
  static_cast<void>(Ten().open(folder / "a.csv"));
  static_cast<void>(Ten(true).open(folder / "a.h5"));
  CHECK(folder.entries() == 0);
}

TEST_CASE("an output that is not a regular file gets its rows immediately") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  Ten sweep;
  const auto file = sweep.open("/dev/fd/" + std::to_string(ends[1]));
  sweep.append(*file, 100, 103);
  char buffer[4096];
  const ssize_t got = read(ends[0], buffer, sizeof buffer);
  CHECK(std::string(buffer, static_cast<std::size_t>(std::max<ssize_t>(0, got))) ==
        header + rows(100, 103));
  close(ends[0]);
  close(ends[1]);
}

}  // namespace bbsim_test::test_case_file
