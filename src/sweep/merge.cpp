// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/merge.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "file/table_writer.hpp"
#include "file/target.hpp"
#include "sweep/merge_parts.hpp"

namespace bbsim::sweep {
namespace {

bool is_hdf5(const std::string& file) {
  return file::format_of(file) == file::Format::hdf5;
}

struct ShardName {
  std::size_t number, of;
};

// Reads the numbers in "...-2of3.csv".
std::optional<ShardName> shard_in(const std::string& file) {
  const std::string stem = std::filesystem::path(file).stem();
  const std::size_t dash = stem.rfind('-'), of = stem.rfind("of");
  if (dash == std::string::npos || of == std::string::npos || of < dash) return {};
  const std::string_view text = stem;
  const auto number = number_in<std::size_t>(text.substr(dash + 1, of - dash - 1)),
             count = number_in<std::size_t>(text.substr(of + 2));
  return number && count ? std::optional(ShardName{*number, *count}) : std::nullopt;
}

void check_names(const std::vector<std::string>& parts) {
  std::size_t of = 0;
  std::set<std::size_t> seen;
  for (const std::string& part : parts) {
    if (const auto name = shard_in(part)) {
      of = std::max(of, name->of);
      seen.insert(name->number);
    }
  }
  for (std::size_t k = 1; k <= of && !seen.empty(); ++k) {
    if (seen.count(k) == 0) {
      throw InputError("found parts of " + std::to_string(of) + ", but not part " +
                       std::to_string(k) + "; allowed: all parts of the sweep");
    }
  }
}

}  // namespace

Merged merge_cases(const std::vector<std::string>& parts, const std::string& target,
                   const std::atomic<bool>& stop) {
  check_names(parts);
  const bool to_hdf5 = !file::is_written_directly(target) && is_hdf5(target);
  file::require_table_name(target);
  const auto hdf5 = static_cast<std::size_t>(std::count_if(parts.begin(), parts.end(), is_hdf5));
  if ((hdf5 > 0) != to_hdf5 || (hdf5 > 0 && hdf5 < parts.size())) {
    throw InputError("found CSV and HDF5 together; allowed: parts and a file of one format");
  }
  return to_hdf5 ? merge_hdf5(parts, target, stop) : merge_csv(parts, target, stop);
}

std::string plan_of_part(const std::string& part) {
  const std::string path = file::follow_links(part).value_or(part);
  std::error_code ignored;
  const auto exists = [&](const std::string& file) {
    return std::filesystem::exists(std::filesystem::symlink_status(file, ignored));
  };
  return exists(path + ".plan") && !exists(path + ".part") ? path + ".plan" : "";
}

void check_case(const std::string& file, std::size_t found, std::size_t expected) {
  if (found == expected) return;
  throw InputError(file + ": found case " + std::to_string(found) + " where case " +
                   std::to_string(expected) +
                   " should come; allowed: every case of the sweep once");
}

void check_all_there(std::size_t found, const std::string& expected) {
  if (std::to_string(found) == expected) return;
  throw InputError("found " + std::to_string(found) + " cases of " + expected +
                   "; allowed: all parts of the sweep");
}

std::string names_of(const InstructionSets& sets) {
  std::string list;
  for (const std::string& name : sets) list += (list.empty() ? "" : " and ") + name;
  return list;
}

std::string note_on(const InstructionSets& sets) {
  if (sets.size() < 2) return "";
  return "the parts are of " + names_of(sets) + ": alike within the tolerance, not bit for bit";
}

}  // namespace bbsim::sweep
