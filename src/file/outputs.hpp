// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The one place that knows all files of a command: nothing that it writes to is another of them.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace bbsim::file {

// A command says what it reads, then what it writes, before it opens the latter. Files are told
// apart by device and inode, so through links, other paths to them and descriptors; one that is not
// there yet, by its folder and its name there. Devices and pipes are nobody's.
class Outputs {
 public:
  // `what` the file is to the user: "the scenario". "-" is standard input.
  void reads(const std::string& file, const std::string& what);

  // `what` names the file: "-o", "--summary". "-" is standard output. Throws InputError, with both
  // names and what to do, if the file is one of those that were named before.
  void writes(const std::string& file, const std::string& what);

 private:
  struct Place {
    dev_t device;
    ino_t inode;       // of the file, or of its folder if it is not there yet
    std::string name;  // there; empty if it is

    bool operator==(const Place&) const = default;
  };
  struct File {
    std::string name, what;
    bool read;
    Place place;
  };
  [[nodiscard]] static std::optional<Place> place_of(const std::string& file, int standard_stream);

  std::vector<File> files_;
};

}  // namespace bbsim::file
