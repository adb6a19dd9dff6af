// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Detects conflicts between a command's files: no output may be another output or an input.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace bbsim::file {

// A command registers its inputs, then its outputs, before it opens an output. Files are compared
// by device and inode, so links, other paths and descriptors do not hide a conflict. A file that
// does not exist yet is compared by its folder and its name. Devices and pipes never conflict.
class Outputs {
 public:
  // `what` describes the file for the user: "the scenario". "-" is standard input.
  void reads(const std::string& file, const std::string& what);

  // `what` names the option: "-o", "--summary". "-" is standard output. Throws InputError, with
  // both names and the remedy, if the file was registered before.
  void writes(const std::string& file, const std::string& what);

 private:
  struct Place {
    dev_t device;
    ino_t inode;       // of the file, or of its folder if the file does not exist
    std::string name;  // in the folder; empty if the file exists

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
