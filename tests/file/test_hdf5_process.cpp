// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// HDF5 files are read in a separate process. Its failure is an error with a reason; the sizes
// declared in a file are checked; and no file content reaches a terminal raw.
#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <optional>
#include <thread>

#include "base/error.hpp"
#include "catch.hpp"
#include "file/descriptor.hpp"
#include "file/hdf5_process.hpp"
#include "file/hdf5_table.hpp"
#include "file/table_writer.hpp"
#include "support/folder.hpp"
#include "support/tables.hpp"

using bbsim::InputError;
using bbsim::file::Descriptor;
using bbsim::file::Hdf5Block;
using bbsim::file::Hdf5Process;
using bbsim::file::Hdf5TableReader;
using bbsim::file::Hdf5Trouble;
using bbsim::file::read_table;
using bbsim::file::TableData;
using Catch::Matchers::Contains;

namespace {

std::string refusal(const std::string& file) {
  return message_of<InputError>([&] { (void)read_table(file); });
}

// Replaces the reader program with a script, for files opened from now on.
class FakeReader {
 public:
  explicit FakeReader(const std::string& script) {
    if (const char* before = std::getenv("BBSIM_MODULE_PATH")) before_ = before;
    const std::string file = folder_.put("bbsim-hdf5-reader", script);
    chmod(file.c_str(), 0755);
    setenv("BBSIM_MODULE_PATH", folder_.name().c_str(), 1);
  }
  ~FakeReader() {
    if (before_) {
      setenv("BBSIM_MODULE_PATH", before_->c_str(), 1);
    } else {
      unsetenv("BBSIM_MODULE_PATH");
    }
  }
  FakeReader(const FakeReader&) = delete;
  FakeReader& operator=(const FakeReader&) = delete;

 private:
  Folder folder_;
  std::optional<std::string> before_;
};

// A file of one dataset, created by `make`.
template <class Make>
std::string foreign(const Folder& folder, const std::string& name, Make make) {
  const std::string file = folder / name;
  const hid_t id = H5Fcreate(file.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  make(id, creation);
  H5Pclose(creation);
  H5Fclose(id);
  return file;
}

hid_t dataset_of(hid_t file, const char* name, hsize_t rows, hid_t creation) {
  const hid_t space = H5Screate_simple(1, &rows, nullptr);
  const hid_t id =
      H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  H5Sclose(space);
  return id;
}

}  // namespace

TEST_CASE("a reader that is killed by a signal is an error that says so") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  write_table(file, {{"t", "x"}, {{0, 1}, {2, 3}}});
  const auto with = [&](const std::string& script) {
    const FakeReader fake("#!/bin/sh\n" + script + "\n");
    return refusal(file);
  };
  const std::string start = "cannot read " + file + ": ";
  const std::string damaged = ": the file is damaged, or not valid HDF5";
  CHECK(with("kill -SEGV $$") ==
        start + "the HDF5 library failed on it (signal 11, Segmentation fault)" + damaged);
  CHECK_THAT(with("kill -ABRT $$"), Contains("(signal 6, Aborted)"));
  CHECK(with("kill -PROF $$") == start + "the HDF5 library does not finish reading it" + damaged);
  CHECK_THAT(with("kill -KILL $$"), Contains("was ended from outside (signal 9, Killed)"));
  CHECK_THAT(with("exit 3"), Contains("the HDF5 reader ended with code 3"));
  CHECK_THAT(with("exit 127"), Contains("does not start; install the HDF5 library"));
  CHECK_THAT(with("echo nonsense and more of it"), Contains("another version of bbsim"));
  CHECK(refusal(file).empty());  // the real reader still works
}

// The effect on the library depends on its version: 1.10.8 divides by zero on the first.
TEST_CASE("a file whose chunks have no dimensions is an error") {
  const Folder folder;
  const std::string sound = foreign(folder, "sound.h5", [](hid_t id, hid_t creation) {
    const hsize_t chunk = 1000;
    H5Pset_chunk(creation, 1, &chunk);
    const hid_t dataset = dataset_of(id, "x", 1000, creation);
    const std::vector<double> numbers(1000, 1.5);
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
    H5Dclose(dataset);
  });
  CHECK(read_table(sound).columns[0] == std::vector<double>(1000, 1.5));
  std::string bytes = content_of(sound);
  // The layout message: version 3, chunked, 2 dimensions, an address, then their sizes.
  const std::size_t sizes = bytes.find(std::string("\xe8\x03\0\0\x08\0\0\0", 8));
  REQUIRE(sizes != std::string::npos);
  REQUIRE(bytes.substr(sizes - 11, 3) == "\x03\x02\x02");
  bytes[sizes - 9] = 0;
  const std::string file = folder.put("damaged.h5", bytes);
  CHECK_THAT(refusal(file), Contains("cannot read " + file + ": "));
}

// On this one it loops forever.
TEST_CASE("a file with dangling string references is an error") {
  const Folder folder;
  const std::string sound = foreign(folder, "sound.h5", [](hid_t id, hid_t) {
    const hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, H5T_VARIABLE);
    const hsize_t rows = 3;
    const hid_t space = H5Screate_simple(1, &rows, nullptr);
    const hid_t dataset = H5Dcreate2(id, "s", text, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const std::array<const char*, 3> texts{"the first one", "the second one", "the third one"};
    H5Dwrite(dataset, text, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data());
    H5Dclose(dataset);
    H5Sclose(space);
    H5Tclose(text);
  });
  std::string bytes = content_of(sound);
  const std::size_t second = bytes.find("the second one");
  REQUIRE(second != std::string::npos);
  // Preceding it in the heap: its index, 2 bytes of 8, and its size, 8 bytes.
  bytes.replace(second - 16, 2, 2, '\0');
  bytes.replace(second - 8, 8, 8, '\0');
  const std::string file = folder.put("damaged.h5", bytes);
  Hdf5Block block;
  CHECK_THAT(message_of<InputError>([&] {
               Hdf5TableReader reader(file);
               reader.read(block);
             }),
             Contains("cannot read " + file + ": "));
}

TEST_CASE("a reader that cannot be started is an error") {
  const Folder folder;
  write_table(folder / "a.h5", {{"t"}, {{0}}});
  {
    const FakeReader fake("#!/none/at/all\n");
    CHECK_THAT(refusal(folder / "a.h5"),
               Contains("cannot start a process to read it: no such file or directory"));
  }
  const char* before = std::getenv("BBSIM_MODULE_PATH");
  const std::string kept = before == nullptr ? "" : before;
  setenv("BBSIM_MODULE_PATH", folder.name().c_str(), 1);
  CHECK_THAT(refusal(folder / "a.h5"),
             Contains("the HDF5 reader bbsim-hdf5-reader is not in " + folder.name()));
  if (before != nullptr) setenv("BBSIM_MODULE_PATH", kept.c_str(), 1);
  if (before == nullptr) unsetenv("BBSIM_MODULE_PATH");
}

TEST_CASE("a broken connection to the reader is an error, without waiting for the reader's end") {
  const int output = open("/", O_RDONLY | O_DIRECTORY | O_CLOEXEC);  // read() of it is an error
  REQUIRE(output >= 0);
  const pid_t child = fork();
  if (child == 0) {
    execlp("sleep", "sleep", "60", nullptr);
    _exit(127);
  }
  REQUIRE(child > 0);
  const auto started = std::chrono::steady_clock::now();
  {
    Hdf5Process process(child, Descriptor(output), Descriptor());
    CHECK(message_of<Hdf5Trouble>([&] { (void)process.line(); }) ==
          "communication with the HDF5 reader failed: is a directory");
  }
  CHECK(std::chrono::steady_clock::now() - started < std::chrono::seconds(20));
}

TEST_CASE("many files may be open together, and an abandoned one leaves no process") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  const TableData table = random_table(3, 100000);  // more than a pipe holds
  write_table(file, table);
  {
    std::vector<std::unique_ptr<Hdf5TableReader>> readers;
    for (int i = 0; i < 20; ++i) readers.push_back(std::make_unique<Hdf5TableReader>(file));
    Hdf5Block block;
    readers[17]->read(block);
    CHECK(same_bits(block.values[2], table.columns[2]));
  }
  CHECK(waitpid(-1, nullptr, WNOHANG) == -1);
  CHECK(errno == ECHILD);
}

TEST_CASE("concurrent threads each read their own rows") {
  const Folder folder;
  constexpr std::size_t threads = 6;
  std::vector<TableData> tables;
  for (std::size_t i = 0; i < threads; ++i) {
    tables.push_back(random_table(2, 5000));
    std::fill(tables[i].columns[1].begin(), tables[i].columns[1].end(), static_cast<double>(i));
    write_table(folder / (std::to_string(i) + ".h5"), tables[i]);
  }
  std::atomic<int> wrong{0};
  std::vector<std::thread> all;
  for (std::size_t i = 0; i < threads; ++i) {
    all.emplace_back([&, i] {
      for (int again = 0; again < 10; ++again) {
        const TableData back = read_table(folder / (std::to_string(i) + ".h5"));
        if (!same_bits(back.columns[1], tables[i].columns[1])) ++wrong;
      }
    });
  }
  for (std::thread& one : all) one.join();
  CHECK(wrong == 0);
}

TEST_CASE("a reader's message is the reason if it ends with 1, and is shown safe for a terminal") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  write_table(file, random_table(3, 3000));
  const auto with = [&](const std::string& script) {
    const FakeReader fake("#!/bin/sh\n" + script + "\n");
    return refusal(file);
  };
  const std::string start = "cannot read " + file + ": ";
  CHECK(with("printf 'it is \\033[2Jred' >&2; exit 1") == start + "it is \\x1b[2Jred");
  CHECK_THAT(with("echo why >&2; exit 3"), Contains("the HDF5 reader ended with code 3"));
  CHECK_THAT(with("echo why >&2; kill -SEGV $$"), Contains("(signal 11, Segmentation fault)"));
  // Its output is discarded however long it is, so it never blocks.
  CHECK_THAT(with("head -c 5000000 /dev/zero >&2; exit 3"), Contains("ended with code 3"));
}

TEST_CASE("an incomplete or malformed table from the reader is an error") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  write_table(file, random_table(3, 3000));
  const auto with = [&](const std::string& head) {
    const FakeReader fake("#!/bin/sh\nprintf '%s\\n' '" + head + "'\n");
    return refusal(file);
  };
  const auto table = [](const std::string& rows, const std::string& kind) {
    return R"({"bbsim_table": 1, "rows": )" + rows +
           R"(, "columns": [{"name": "x", "unit": "", "meaning": "", "kind": ")" + kind +
           R"(", "width": 1}], "axes": [], "attributes": [], "inputs": []})";
  };
  const std::string start = "cannot read " + file + ": ";
  CHECK(with(table("0", "number")).empty());
  CHECK_THAT(with(table("1", "number")), Contains("the HDF5 reader ended with code 0"));
  for (const char* rows : {"-1", "1e300", "0.5"}) {
    CHECK_THAT(with(table(rows, "number")), Contains("printed something unexpected"));
  }
  CHECK_THAT(with(table("18446744073709551615", "number")), Contains("there is not enough memory"));
  CHECK_THAT(with(table("\"one\"", "number")), Contains("printed something unexpected"));
  CHECK_THAT(with(R"({"bbsim_table": 1})"), Contains("printed something unexpected"));
  CHECK_THAT(with(R"({"bbsim_table": "1"})"), Contains("printed something unexpected"));
  CHECK_THAT(with(R"({"bbsim_table": 2})"), Contains("another version of bbsim"));
  CHECK_THAT(with("[1]"), Contains("another version of bbsim"));
  CHECK_THAT(with(std::string(200, '[')), Contains("another version of bbsim"));
}

TEST_CASE("a truncated file is an error, and the next one is read") {
  const Folder folder;
  write_table(folder / "a.h5", random_table(3, 3000));
  const std::string whole = content_of(folder / "a.h5");
  const std::string cut = folder.put("cut.h5", whole.substr(0, whole.size() / 2));
  CHECK_THAT(refusal(cut), Contains("opening the file failed"));
  CHECK(refusal(folder / "a.h5").empty());
}

TEST_CASE("a dataset that declares more than the file can contain is refused with its sizes") {
  const Folder folder;
  const std::string file = foreign(folder, "a.h5", [](hid_t id, hid_t creation) {
    const hsize_t chunk = 1024;
    H5Pset_chunk(creation, 1, &chunk);
    for (const char* name : {"t", "x", "y"}) H5Dclose(dataset_of(id, name, 40000000, creation));
  });
  const std::uintmax_t size = std::filesystem::file_size(file);
  CHECK(size < 5000);
  CHECK(refusal(file) ==
        "cannot read " + file +
            ": dataset t declares 40000000 rows, 320000000 bytes; the file has " +
            std::to_string(size) +
            " bytes, 0 of them for it: it is damaged, or the dataset was never filled");

  // The largest possible numbers.
  const std::string most = foreign(folder, "most.h5", [](hid_t id, hid_t creation) {
    const hsize_t chunk = 1024;
    H5Pset_chunk(creation, 1, &chunk);
    H5Dclose(dataset_of(id, "x", ~hsize_t{0} / 2, creation));
  });
  CHECK_THAT(refusal(most), Contains("declares 9223372036854775807 rows, 18446744073709551615 "));
}

TEST_CASE("a compressed dataset may be larger than the file, but only by a bounded factor") {
  const Folder folder;
  constexpr hsize_t rows = 2000000;
  const auto packed = [&](const std::string& name, hsize_t declared) {
    return foreign(folder, name, [&](hid_t id, hid_t creation) {
      const hsize_t chunk = 500000;
      H5Pset_chunk(creation, 1, &chunk);
      H5Pset_deflate(creation, 6);
      const hid_t dataset = dataset_of(id, "x", declared, creation);
      const std::vector<double> numbers(rows, 1.5);
      const hid_t memory = H5Screate_simple(1, &rows, nullptr);
      const hid_t space = H5Dget_space(dataset);
      const hsize_t first = 0;
      H5Sselect_hyperslab(space, H5S_SELECT_SET, &first, nullptr, &rows, nullptr);
      H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, numbers.data());
      H5Sclose(space);
      H5Sclose(memory);
      H5Dclose(dataset);
    });
  };
  const std::string sound = packed("sound.h5", rows);
  CHECK(std::filesystem::file_size(sound) < 200000);  // 16 MB of numbers
  CHECK(read_table(sound).columns ==
        std::vector<std::vector<double>>{std::vector<double>(rows, 1.5)});
  CHECK_THAT(refusal(packed("false.h5", 1000 * rows)), Contains("declares 2000000000 rows"));
}

TEST_CASE("external data in other files are not read") {
  const Folder folder;
  folder.put("secret", std::string(800, 's'));
  write_table(folder / "other.h5", {{"x"}, {{1, 2}}});
  const std::string raw = foreign(folder, "raw.h5", [&](hid_t id, hid_t creation) {
    H5Pset_external(creation, (folder / "secret").c_str(), 0, 800);
    H5Dclose(dataset_of(id, "x", 100, creation));
  });
  CHECK_THAT(refusal(raw), Contains("dataset x is not a column: its numbers are in other files"));

  const std::string mapped = foreign(folder, "mapped.h5", [&](hid_t id, hid_t creation) {
    const hsize_t rows = 2;
    const hid_t space = H5Screate_simple(1, &rows, nullptr);
    H5Pset_virtual(creation, space, (folder / "other.h5").c_str(), "x", space);
    H5Sclose(space);
    H5Dclose(dataset_of(id, "x", 2, creation));
  });
  CHECK_THAT(refusal(mapped), Contains("its numbers are in other files"));

  const std::string linked = foreign(folder, "linked.h5", [&](hid_t id, hid_t) {
    H5Lcreate_external((folder / "other.h5").c_str(), "x", id, "x", H5P_DEFAULT, H5P_DEFAULT);
  });
  CHECK_THAT(refusal(linked), Contains("x is a link to another file"));

  const std::string way_round = foreign(folder, "way-round.h5", [&](hid_t id, hid_t) {
    const hid_t group = H5Gcreate2(id, "g", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external((folder / "other.h5").c_str(), "x", group, "x", H5P_DEFAULT, H5P_DEFAULT);
    H5Gclose(group);
    H5Lcreate_soft("/g/x", id, "x", H5P_DEFAULT, H5P_DEFAULT);
  });
  CHECK_THAT(refusal(way_round), Contains("opening x failed"));

  const std::string within = foreign(folder, "within.h5", [&](hid_t id, hid_t creation) {
    H5Dclose(dataset_of(id, "x", 2, creation));
    H5Lcreate_soft("/x", id, "y", H5P_DEFAULT, H5P_DEFAULT);
  });
  CHECK(read_table(within).names == std::vector<std::string>{"x", "y"});
}

TEST_CASE("dataset names are shown safe for a terminal") {
  const Folder folder;
  const std::string file = foreign(folder, "a\x1b[2J.h5", [](hid_t id, hid_t) {
    const std::array<hsize_t, 3> sizes{2, 2, 2};
    const hid_t space = H5Screate_simple(3, sizes.data(), nullptr);
    H5Dclose(H5Dcreate2(id, "x\x1b]0;title\x07\n", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT,
                        H5P_DEFAULT));
    H5Sclose(space);
  });
  CHECK(refusal(file) == "cannot read " + (folder / "a\\x1b[2J.h5") +
                             ": dataset x\\x1b]0;title\\x07\\n is not a column: it has 3 "
                             "dimensions; numbers may have 1 or 2, text 1");
}

// As after trap '' CHLD in a shell.
TEST_CASE("files are read even if SIGCHLD is ignored") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  write_table(file, {{"t", "x"}, {{0, 1}, {2, 3}}});
  void (*const before)(int) = std::signal(SIGCHLD, SIG_IGN);
  CHECK(refusal(file).empty());
  CHECK_THAT(refusal(folder.put("b.h5", "none")), Contains("it is not an HDF5 file"));
  {
    const FakeReader fake("#!/bin/sh\nkill -SEGV $$\n");
    CHECK_THAT(refusal(file),
               Contains("the HDF5 reader ended while reading it: the file is damaged"));
  }
  static_cast<void>(std::signal(SIGCHLD, before));
}
