// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A file is complete or absent, whatever is at its path.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "base/error.hpp"
#include "catch.hpp"
#include "file/atomic_file.hpp"
#include "file/leftovers.hpp"
#include "support/child.hpp"
#include "support/folder.hpp"
#include "support/limits.hpp"
#include "support/rights.hpp"

namespace bbsim_test::test_atomic_file {

using bbsim::OutputError;
using bbsim::file::AtomicFile;
using bbsim::file::write_file;
using Catch::Matchers::Contains;

TEST_CASE("a file appears at commit, and without it an existing one is left alone") {
  const Folder folder;
  const std::string file = folder / "a.csv";
  {
    AtomicFile atomic(file);
    atomic.write("whole");
    CHECK_FALSE(std::filesystem::exists(file));
    atomic.commit();
  }
  CHECK(content_of(file) == "whole");
  {
    AtomicFile atomic(file);
    atomic.write(std::string(3 * AtomicFile::buffer_size, 'x'));  // part of it reaches the disk
  }
  CHECK(content_of(file) == "whole");
  CHECK(folder.entries() == 1);
}

TEST_CASE("bytes pass the buffer in order, whatever their sizes") {
  const Folder folder;
  const std::string file = folder / "a.txt";
  std::string expected;
  AtomicFile atomic(file);
  for (std::size_t size : {1UL, 0UL, AtomicFile::buffer_size - 1, AtomicFile::buffer_size,
                           AtomicFile::buffer_size + 1, 7UL, 100000UL}) {
    const std::string part(size, static_cast<char>('a' + size % 26));
    atomic.write(part);
    char* to = atomic.reserve(3);
    to[0] = '<';
    to[1] = '>';
    atomic.advance(to + 2);
    expected += part + "<>";
  }
  atomic.commit();
  CHECK(content_of(file) == expected);
}

TEST_CASE("a symbolic link stays and its target is replaced") {
  const Folder folder;
  std::filesystem::create_directory(folder / "elsewhere");
  const std::string real = folder / "elsewhere/real.csv";
  std::filesystem::create_symlink("elsewhere/step.csv", folder / "link.csv");
  std::filesystem::create_symlink("real.csv", folder / "elsewhere/step.csv");

  write_file(folder / "link.csv", "first");  // through links whose target does not exist yet
  CHECK(content_of(real) == "first");
  write_file(folder / "link.csv", "second");
  CHECK(content_of(real) == "second");
  CHECK(std::filesystem::is_symlink(folder / "link.csv"));
  CHECK(std::filesystem::is_symlink(folder / "elsewhere/step.csv"));
  CHECK_FALSE(std::filesystem::is_symlink(real));
}

TEST_CASE("permissions follow the umask, or the replaced file") {
  const Folder folder;
  const mode_t before = umask(027);
  write_file(folder / "new.csv", "x");
  umask(before);
  CHECK(permissions_of(folder / "new.csv") == 0640);

  const std::string old = folder.put("old.csv", "old");
  REQUIRE(chmod(old.c_str(), 0604) == 0);
  write_file(old, "new");
  CHECK(content_of(old) == "new");
  CHECK(permissions_of(old) == 0604);
}

TEST_CASE("a write-protected file is not replaced") {
  const Folder folder;
  const std::string file = folder.put("a.csv", "old");
  REQUIRE(chmod(file.c_str(), 0444) == 0);
  CHECK(status_of_child([&] {
          drop_rights_over_files();
          const std::string message = message_of<OutputError>([&] { write_file(file, "new"); });
          return message.find("permission denied") != std::string::npos ? 0 : 1;
        }) == 0);
  CHECK(content_of(file) == "old");
}

TEST_CASE("an impossible output is refused before anything is done, but not the longest name") {
  const Folder folder;
  folder.put("file", "");
  std::filesystem::create_symlink("b", folder / "a");
  std::filesystem::create_symlink("a", folder / "b");
  const std::string longest(255, 'n');
  const std::pair<std::string, std::string> refused[] = {
      {folder / "none/a.csv", "there is no folder " + (folder / "none")},
      {folder / "file/a.csv", "not a directory"},
      {folder.name(), "is a directory"},
      {folder / "none/", "is a directory"},
      {"", "name is empty"},
      {folder / "a", "too many levels of symbolic links"},
      {folder / (longest + "n"), "file name too long"},
      // Nobody, not even root, may create a file there; the errno depends on the kernel.
      {"/proc/a.csv", "cannot write /proc/a.csv"},
  };
  for (const auto& [target, said] : refused) {
    CHECK_THAT(message_of<OutputError>([&, name = target] { const AtomicFile file(name); }),
               Contains("cannot write") && Contains(target) && Contains(said));
  }
  CHECK(folder.entries() == 3);
  write_file(folder / longest, "x");
  CHECK(content_of(folder / longest) == "x");
}

TEST_CASE("a full device is an error, at the latest when the file is completed") {
  AtomicFile small("/dev/full");
  small.write("x");
  CHECK_THAT(message_of<OutputError>([&] { small.commit(); }),
             Contains("cannot write /dev/full: no space left on device; free some"));

  AtomicFile large("/dev/full");
  CHECK_THROWS_AS(large.write(std::string(2 * AtomicFile::buffer_size, 'x')), OutputError);
  CHECK(std::filesystem::is_character_file("/dev/full"));
}

TEST_CASE("a full file system keeps the old file and leaves no temporary") {
  const Folder folder;
  const std::string file = folder.put("a.csv", "old");
  {
    const FileSizeLimit limit(50000);  // bytes, between one and two buffers
    CHECK_THAT(message_of<OutputError>([&] { write_file(file, std::string(100000, 'x')); }),
               Contains("file too large; the limit is the file system's, or that of ulimit -f"));
  }
  CHECK(content_of(file) == "old");
  CHECK(folder.entries() == 1);
}

TEST_CASE("a folder created under the name in the meantime is an error at commit") {
  const Folder folder;
  {
    AtomicFile file(folder / "a.csv");
    std::filesystem::create_directory(folder / "a.csv");
    CHECK_THAT(message_of<OutputError>([&] { file.commit(); }), Contains("is a directory"));
  }
  CHECK(folder.entries() == 1);
}

TEST_CASE("devices are written to and stay devices") {
  write_file("/dev/null", "x");
  CHECK(std::filesystem::is_character_file("/dev/null"));

  const Folder folder;
  std::filesystem::create_symlink("/dev/null", folder / "a.csv");
  write_file(folder / "a.csv", "x");
  CHECK(std::filesystem::is_symlink(folder / "a.csv"));
  CHECK(bbsim::file::is_written_directly(folder / "a.csv"));
  CHECK_FALSE(bbsim::file::is_written_directly(folder / "b.csv"));
  CHECK_FALSE(bbsim::file::is_written_directly(folder.name()));
}

TEST_CASE("a FIFO is written through") {
  const Folder folder;
  const std::string fifo = folder / "fifo";
  REQUIRE(mkfifo(fifo.c_str(), 0600) == 0);
  std::string got;
  std::thread reader([&] { got = content_of(fifo); });
  write_file(fifo, std::string(200000, 'x'));  // more than a pipe holds
  reader.join();
  CHECK(got.size() == 200000);
  CHECK(std::filesystem::is_fifo(fifo));
  CHECK(folder.entries() == 1);
}

TEST_CASE("a reader that closes early is an error") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  close(ends[0]);
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  const std::string name = "/dev/fd/" + std::to_string(ends[1]);
  CHECK_THAT(message_of<OutputError>([&] { write_file(name, "x"); }), Contains("broken pipe"));
  (void)std::signal(SIGPIPE, before);
  close(ends[1]);
}

TEST_CASE("a nonblocking pipe is waited for") {
  int ends[2];
  REQUIRE(pipe2(ends, O_NONBLOCK) == 0);
  constexpr std::size_t size = 300000;  // more than a pipe holds
  std::size_t got = 0;
  std::thread reader([&] {
    char buffer[4096];
    while (got < size) {
      const ssize_t n = read(ends[0], buffer, sizeof buffer);
      if (n > 0) got += static_cast<std::size_t>(n);
      if (n < 0) std::this_thread::yield();
    }
  });
  write_file("/dev/fd/" + std::to_string(ends[1]), std::string(size, 'x'));
  reader.join();
  CHECK(got == size);
  close(ends[0]);
  close(ends[1]);
}

// Uses the descriptor's own position, so that a shell's >> appends.
TEST_CASE("standard output that goes to a file is neither replaced nor truncated") {
  const Folder folder;
  const std::string file = folder.put("out", "before\n");
  std::filesystem::create_symlink("/dev/stdout", folder / "link");
  for (const std::string& name : {std::string("-"), std::string("/dev/stdout"),
                                  std::string("/proc/self/fd/1"), folder / "link"}) {
    CHECK(status_of_child([&] {
            dup2(open(file.c_str(), O_WRONLY | O_APPEND), STDOUT_FILENO);
            write_file(name, "more\n");
            return 0;
          }) == 0);
  }
  CHECK(content_of(file) == "before\nmore\nmore\nmore\nmore\n");
}

TEST_CASE("a closed standard output is an error, and no other file is written instead") {
  const Folder folder;
  CHECK(status_of_child([&] {
          close(STDOUT_FILENO);
          close(STDERR_FILENO);
          const std::string message = message_of<OutputError>([] { write_file("-", "x"); });
          const AtomicFile file(folder / "a.csv");
          const bool good = message == "cannot write standard output: bad file descriptor" &&
                            fcntl(STDOUT_FILENO, F_GETFD) < 0 && fcntl(STDERR_FILENO, F_GETFD) < 0;
          return good ? 0 : 1;
        }) == 0);
}

TEST_CASE("a killed process leaves the old file, and after other signals no temporary") {
  const Folder folder;
  const std::string old = folder.put("old.csv", "old");
  const auto begin = [&] {
    (void)std::signal(SIGTERM, [](int) {
      bbsim::file::remove_temporaries();
      _exit(130);
    });
    for (const std::string& name : {folder / "new.csv", old}) {
      auto* file = new AtomicFile(name);
      file->write(std::string(2 * AtomicFile::buffer_size, 'x'));
    }
    if (folder.entries() != 3) _exit(98);
  };
  const auto ended_by = [&](int signal) {
    return status_of_child([&] {
      begin();
      return raise(signal);
    });
  };
  CHECK(WEXITSTATUS(ended_by(SIGTERM)) == 130);
  CHECK(folder.entries() == 1);
  CHECK(WTERMSIG(ended_by(SIGKILL)) == SIGKILL);
  CHECK_FALSE(std::filesystem::exists(folder / "new.csv"));
  CHECK(content_of(old) == "old");
}

TEST_CASE("a forked process leaves its parent's temporaries alone") {
  const Folder folder;
  const std::string name = folder.put("temporary", "x");
  bbsim::file::remember_temporary(name.c_str());
  CHECK(status_of_child([] {
          bbsim::file::remove_temporaries();
          return 0;
        }) == 0);
  CHECK(folder.entries() == 1);
  bbsim::file::remove_temporaries();
  CHECK(folder.entries() == 0);
  bbsim::file::forget_temporary(name.c_str());
}

}  // namespace bbsim_test::test_atomic_file
