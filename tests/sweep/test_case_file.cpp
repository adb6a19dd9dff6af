// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A sweep's results on their way into a file: an earlier run's rows are checked, conflicts refused,
// and nothing is discarded before the result is complete.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.hpp"
#include "catch.hpp"
#include "file/hdf5_table.hpp"
#include "support/folder.hpp"
#include "sweep/case_file.hpp"

namespace bbsim_test::test_case_file {

using namespace bbsim::file;
using namespace bbsim::sweep;
using bbsim::InputError;
using bbsim::OutputError;
using Catch::Matchers::Contains;

namespace {

const std::string plan = R"({"version": "1", "instruction_set": "avx2", "seed": 1})";

// Ten cases from number 100 on.
CaseFileLayout layout(bool series = false, std::size_t group = 1) {
  CaseFileLayout made;
  made.columns = {{"case", "1", ""},
                  {"gravity", "SI", ""},
                  {"status", "", "", Hdf5Kind::text},
                  {"reason", "", "", Hdf5Kind::text},
                  {"end_x", "m", ""}};
  made.first_case = 100;
  made.cases = 10;
  made.group = group;
  if (series) {
    made.axis = {"t", "s", ""};
    made.axis_values = {0, 1, 2};
    made.columns.push_back({"x", "m", "", Hdf5Kind::series, 3});
  }
  return made;
}

const std::string header = "case,gravity,status,reason,end_x\n";

std::string row(std::size_t number) {
  const std::string text = std::to_string(number);
  return text + ",9." + text +
         (number % 4 == 0 ? ",failed,\"so, and\",nan\n" : ",done,,0." + text + "\n");
}

std::string rows(std::size_t first, std::size_t last) {
  std::string text;
  for (std::size_t number = first; number < last; ++number) text += row(number);
  return text;
}

std::vector<std::vector<double>> series_of(std::size_t first, std::size_t last) {
  std::vector<std::vector<double>> series(1);
  for (std::size_t number = first; number < last; ++number) {
    for (int i = 0; i < 3; ++i) series[0].push_back(static_cast<double>(number) + 0.1 * i);
  }
  return series;
}

// Appends cases first ... last - 1.
void append(CaseFile& file, std::size_t first, std::size_t last, bool series = false) {
  file.append(rows(first, last), last - first,
              series ? series_of(first, last) : std::vector<std::vector<double>>{});
}

void leave_unfinished(const std::string& target, std::size_t last, bool series = false) {
  const auto file = open_case_file(target, layout(series), plan, false);
  append(*file, 100, last, series);
}

std::string opening_fails(const std::string& target, const std::string& with_plan = plan,
                          bool resume = false) {
  return message_of<InputError>(
      [&] { static_cast<void>(open_case_file(target, layout(), with_plan, resume)); });
}

std::string writing_fails(const std::string& target) {
  return message_of<OutputError>(
      [&] { static_cast<void>(open_case_file(target, layout(), plan, true)); });
}

}  // namespace

TEST_CASE("rows become a file, and a resumed part gives the same bytes") {
  const Folder folder;
  const std::string ending =
      GENERATE(std::string(".csv"), std::string(".h5"), std::string(".HDF5"));
  const bool series = ending != ".csv";
  CAPTURE(ending);
  {
    const auto file = open_case_file(folder / ("a" + ending), layout(series), plan, false);
    append(*file, 100, 110, series);
    file->finish({{"title", "t"}});
  }
  CHECK(folder.entries() == 1);
  if (!series) CHECK(content_of(folder / "a.csv") == header + rows(100, 110));

  leave_unfinished(folder / ("b" + ending), 107, series);
  CHECK(folder.entries() == (series ? 4 : 3));
  {
    const auto file = open_case_file(folder / ("b" + ending), layout(series), plan, true);
    CHECK(file->kept().rows == 7);
    CHECK(file->kept().trouble.empty());
    CHECK(file->kept().statuses.words ==
          std::map<std::string, std::size_t, std::less<>>{{"done", 5}, {"failed", 2}});
    append(*file, 107, 110, series);
    file->finish({{"title", "t"}});
  }
  CHECK(folder.entries() == 2);
  const bool alike = content_of(folder / ("a" + ending)) == content_of(folder / ("b" + ending));
  CHECK(alike);
}

TEST_CASE("whole groups are kept, and a smaller last one") {
  const Folder folder;
  leave_unfinished(folder / "a.csv", 107);
  CHECK(open_case_file(folder / "a.csv", layout(false, 4), plan, true)->kept().rows == 4);
  leave_unfinished(folder / "b.csv", 110);
  const KeptRows kept = open_case_file(folder / "b.csv", layout(false, 4), plan, true)->kept();
  CHECK(kept.rows == 10);
  CHECK(kept.statuses.words ==
        std::map<std::string, std::size_t, std::less<>>{{"done", 7}, {"failed", 3}});
}

TEST_CASE("a part is cut at the first invalid row, and this is reported") {
  const Folder folder;
  const std::string whole = header + rows(100, 108);
  const std::size_t row_103 = whole.find("103,");
  const auto resumed = [&](const std::string& content) {
    leave_unfinished(folder / "a.csv", 101);
    folder.put("a.csv.part", content);
    const auto file = open_case_file(folder / "a.csv", layout(), plan, true);
    KeptRows kept = file->kept();
    append(*file, 100 + kept.rows, 110);
    file->finish({});
    CHECK(content_of(folder / "a.csv") == header + rows(100, 110));
    CHECK(folder.entries() == 1);
    return kept;
  };
  const auto changed = [&](std::size_t place, std::size_t size, const std::string& by) {
    return std::string(whole).replace(place, size, by);
  };
  const std::string start =
      (folder / "a.csv.part") + ": the row of case 103 is not as it was written";
  const std::string& row_of_103 = row(103);

  SECTION("a deleted row") {
    const KeptRows kept = resumed(changed(row_103, row_of_103.size(), ""));
    CHECK(kept.rows == 3);
    CHECK(kept.trouble == start + " (found case 104); continuing from case 103");
  }
  SECTION("a repeated row") {
    const KeptRows kept = resumed(changed(row_103, 0, row(102)));
    CHECK(kept.rows == 3);
    CHECK_THAT(kept.trouble, Contains(start + " (found case 102)"));
  }
  SECTION("zeros") {
    CHECK_THAT(resumed(changed(row_103, 20, std::string(20, '\0'))).trouble,
               Contains(start + " (found zero bytes)"));
    CHECK_THAT(resumed(whole.substr(0, row_103) + std::string(4096, '\0')).trouble,
               Contains(start + " (found zero bytes)"));
  }
  SECTION("a lost field and a damaged number") {
    CHECK_THAT(resumed(changed(whole.find(",done", row_103), 5, "")).trouble, Contains("4 fields"));
    CHECK_THAT(resumed(changed(whole.find("9.103"), 5, "9.1O3")).trouble, Contains("field 2"));
  }
  SECTION("more rows than cases") {
    const KeptRows kept = resumed(header + rows(100, 112));
    CHECK(kept.rows == 10);
    CHECK_THAT(kept.trouble, Contains("more than there are cases"));
  }
  SECTION("the header") {
    const KeptRows kept = resumed(changed(0, 4, std::string(4, '\0')));
    CHECK(kept.rows == 0);
    CHECK_THAT(kept.trouble, Contains("its header is not as it was written"));
  }
  SECTION("the state after a kill is valid") {
    for (std::size_t size = 1; size < whole.size(); ++size) {
      CHECK(resumed(whole.substr(0, size)).trouble.empty());
    }
  }
}

TEST_CASE("damaged trajectories are computed again") {
  const Folder folder;
  const std::string series_file = folder / "a.h5.part.series";
  const auto resumed = [&](const std::string& content) {
    leave_unfinished(folder / "a.h5", 108, true);
    std::ofstream(series_file, std::ios::binary) << content;
    const auto file = open_case_file(folder / "a.h5", layout(true), plan, true);
    KeptRows kept = file->kept();
    append(*file, 100 + kept.rows, 110, true);
    file->finish({});
    Hdf5TableReader reader(folder / "a.h5");
    Hdf5Block block;
    CHECK(reader.read(block));
    CHECK(block.values[5] == series_of(100, 110)[0]);
    return kept;
  };
  leave_unfinished(folder / "a.h5", 108, true);
  const std::string whole = content_of(series_file);
  std::filesystem::remove(folder / "a.h5.part");
  const std::size_t a_case = whole.size() / 8;
  CHECK(resumed(whole).trouble.empty());
  const KeptRows zeros = resumed(std::string(whole).replace(2 * a_case, a_case, a_case, '\0'));
  CHECK(zeros.rows == 2);
  CHECK_THAT(zeros.trouble, Contains("the trajectories of case 102 are not as they were written"));
  const KeptRows swapped = resumed(whole.substr(0, a_case) + whole.substr(2 * a_case, a_case) +
                                   whole.substr(2 * a_case));
  CHECK(swapped.rows == 1);
  CHECK(resumed(whole.substr(0, 5 * a_case + 3)).rows == 5);
}

TEST_CASE("a file with too few rows is not completed, and its part stays") {
  const Folder folder;
  const std::string ending = GENERATE(std::string(".csv"), std::string(".h5"));
  const std::string target = folder / ("a" + ending);
  {
    const auto file = open_case_file(target, layout(), plan, false);
    append(*file, 100, 108);
    CHECK_THAT(message_of<OutputError>([&] { file->finish({}); }), Contains("it has 8 rows of 10"));
  }
  CHECK_FALSE(std::filesystem::exists(target));
  {
    const auto file = open_case_file(target, layout(), plan, true);
    append(*file, 108, 110);
    REQUIRE(truncate((target + ".part").c_str(), 100) == 0);  // by another process
    CHECK_FALSE(message_of<OutputError>([&] { file->finish({}); }).empty());
  }
  CHECK_FALSE(std::filesystem::exists(target));
  CHECK(std::filesystem::exists(target + ".part"));
}

TEST_CASE("a part that loses its name is neither lost nor mistaken for another") {
  const Folder folder;
  const std::string ending = GENERATE(std::string(".csv"), std::string(".h5"));
  const std::string target = folder / ("a" + ending);
  {
    const auto file = open_case_file(folder / ("expected" + ending), layout(), plan, false);
    append(*file, 100, 110);
    file->finish({});
  }
  const auto file = open_case_file(target, layout(), plan, false);
  append(*file, 100, 110);
  CHECK(file->part() == target + ".part");
  REQUIRE(unlink((target + ".part").c_str()) == 0);
  CHECK(file->part().empty());
  SECTION("removed") {
    file->finish({});
  }
  SECTION("replaced") {
    folder.put("a" + ending + ".part", "somebody else's");
    file->finish({});
    CHECK(content_of(target + ".part") == "somebody else's");
  }
  const bool alike = content_of(target) == content_of(folder / ("expected" + ending));
  CHECK(alike);
}

TEST_CASE("no part is written through a link or special file in its place") {
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
    CHECK_THAT(writing_fails(target), Contains("is a directory"));
  }
  CHECK(content_of(precious) == "precious");
  CHECK(folder.entries() == 2);
}

TEST_CASE("trajectories are not written through a link either") {
  const Folder folder;
  const std::string precious = folder.put("precious", "precious");
  std::filesystem::create_symlink("precious", folder / "a.h5.part.series");
  CHECK_THAT(message_of<OutputError>([&] {
               static_cast<void>(open_case_file(folder / "a.h5", layout(true), plan, true));
             }),
             Contains("a.h5.part.series: it is a symbolic link"));
  CHECK(content_of(precious) == "precious");
  CHECK(folder.entries() == 2);
}

TEST_CASE("a part is continued only with the same plan, and differences are reported") {
  const Folder folder;
  const std::string target = folder / "a.csv";
  leave_unfinished(target, 103);
  CHECK_THAT(opening_fails(target), Contains("add --resume"));
  CHECK_THAT(
      opening_fails(target, R"({"version": "1", "instruction_set": "avx2", "seed": 2})", true),
      Contains("of another sweep than this one") && Contains("in its seed;"));
  CHECK_THAT(
      opening_fails(target, R"({"version": "1", "instruction_set": "avx512", "seed": 1})", true),
      Contains("begun with the instruction set avx2, and this is avx512") &&
          Contains("BBSIM_SIMD=avx2"));
  CHECK_THAT(opening_fails(target, R"({"instruction_set": "avx512", "seed": 1, "vary": []})", true),
             Contains("in its version, vary;"));
  folder.put("a.csv.plan", std::string(100, '\0'));
  CHECK_THAT(opening_fails(target, plan, true), Contains("which is not a plan of bbsim"));
  std::filesystem::remove(folder / "a.csv.plan");
  CHECK_THAT(opening_fails(target, plan, true), Contains("found without"));
  CHECK(content_of(target + ".part") == header + rows(100, 103));
}

TEST_CASE("a part belongs to one process at a time") {
  const Folder folder;
  const auto file = open_case_file(folder / "a.csv", layout(), plan, false);
  append(*file, 100, 101);
  CHECK_THAT(opening_fails(folder / "a.csv", plan, true),
             Contains("another bbsim is writing to it"));
  CHECK(content_of(folder / "a.csv.part") == header + row(100));
}

TEST_CASE("a sweep's file keeps the permissions of the file that it replaces") {
  const Folder folder;
  const std::string file = folder.put("a.csv", "old");
  REQUIRE(chmod(file.c_str(), 0600) == 0);
  const auto cases = open_case_file(file, layout(), plan, false);
  CHECK(permissions_of(file + ".part") == 0600);
  CHECK(permissions_of(file + ".plan") == 0600);
  append(*cases, 100, 110);
  REQUIRE(chmod(file.c_str(), 0640) == 0);
  cases->finish({});
  CHECK(content_of(file) == header + rows(100, 110));
  CHECK(permissions_of(file) == 0640);
}

TEST_CASE("an output that cannot be written is reported before any case runs") {
  const Folder folder;
  std::filesystem::create_symlink("loop.csv", folder / "loop.csv");
  CHECK_THAT(writing_fails(folder / "loop.csv"), Contains("too many levels of symbolic links"));
  CHECK_THAT(writing_fails(folder / (std::string(252, 'n') + ".csv")),
             Contains("file name too long"));
  CHECK_THAT(writing_fails(folder / (std::string(248, 'n') + ".csv")),
             Contains("file name too long"));
  CHECK_THAT(writing_fails(folder / "none/a.csv"), Contains("no such file or directory"));
  folder.put("file", "");
  CHECK_THAT(writing_fails(folder / "file/a.csv"), Contains("not a directory"));
  CHECK(folder.entries() == 2);
}

TEST_CASE("a shard keeps its plan beside it, a whole sweep does not") {
  const Folder folder;
  CaseFileLayout shard = layout();
  shard.is_shard = GENERATE(true, false);
  const auto file = open_case_file(folder / "a.csv", shard, plan, false);
  append(*file, 100, 110);
  file->finish({});
  CHECK(folder.entries() == (shard.is_shard ? 2 : 1));
  if (shard.is_shard) CHECK(content_of(folder / "a.csv.plan") == plan);
}

TEST_CASE("a part without rows is removed with its sweep") {
  const Folder folder;
  static_cast<void>(open_case_file(folder / "a.csv", layout(), plan, false));
  static_cast<void>(open_case_file(folder / "a.h5", layout(true), plan, false));
  CHECK(folder.entries() == 0);
}

TEST_CASE("an output that is not a regular file gets its rows immediately") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const auto file = open_case_file("/dev/fd/" + std::to_string(ends[1]), layout(), plan, false);
  append(*file, 100, 103);
  char buffer[4096];
  const ssize_t got = read(ends[0], buffer, sizeof buffer);
  CHECK(std::string(buffer, static_cast<std::size_t>(std::max<ssize_t>(0, got))) ==
        header + rows(100, 103));
  close(ends[0]);
  close(ends[1]);
}

}  // namespace bbsim_test::test_case_file
