#include "record/merge.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string_view>

#include "base/error.hpp"
#include "record/atomic_file.hpp"
#include "record/merge_hdf5.hpp"

namespace bbsim::record {
namespace {

bool is_hdf5(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension();
  return ending == ".h5" || ending == ".hdf5";
}

struct ShardName {
  std::size_t number, of;
};

// "...-2of3.csv"
std::optional<ShardName> shard_in(const std::string& file) {
  const std::string stem = std::filesystem::path(file).stem();
  const std::size_t dash = stem.rfind('-');
  if (dash == std::string::npos) return {};
  const char *const begin = stem.data() + dash + 1, *const end = stem.data() + stem.size();
  ShardName name{};
  const auto first = std::from_chars(begin, end, name.number);
  if (first.ec != std::errc{} || end - first.ptr < 3 || first.ptr[0] != 'o' ||
      first.ptr[1] != 'f') {
    return {};
  }
  const auto second = std::from_chars(first.ptr + 2, end, name.of);
  if (second.ec != std::errc{} || second.ptr != end) return {};
  return name;
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

// The number that a row begins with.
std::size_t case_of(const std::string& file, std::string_view line) {
  std::size_t number = 0;
  const auto result = std::from_chars(line.data(), line.data() + line.size(), number);
  if (result.ec != std::errc{} || result.ptr == line.data() + line.size() || *result.ptr != ',') {
    throw InputError(file +
                     ": found a row that does not begin with the number of a case; allowed: "
                     "what bbsim sweep writes");
  }
  return number;
}

struct Part {
  std::string file, header;
  std::size_t first = 0;  // case; of a part without rows it comes before all
};

Part look_at(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  Part part{file, "", 0};
  if (!stream || !std::getline(stream, part.header)) {
    throw InputError("cannot read " + file + ": it is no file with rows of cases");
  }
  if (!part.header.starts_with("case,")) {
    throw InputError(file + ": found the first column " +
                     part.header.substr(0, part.header.find(',')) +
                     "; allowed: case, as bbsim sweep writes it");
  }
  std::string line;
  if (std::getline(stream, line)) part.first = case_of(file, line);
  return part;
}

std::size_t merge_csv(const std::vector<std::string>& files, const std::string& target) {
  std::vector<Part> parts;
  for (const std::string& file : files) parts.push_back(look_at(file));
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.first < b.first; });
  AtomicFile out(target);
  out.write(parts.front().header + '\n');
  std::size_t next = 0;
  for (const Part& part : parts) {
    if (part.header != parts.front().header) {
      throw InputError(part.file + ": found other columns than in " + parts.front().file +
                       "; allowed: parts of one sweep");
    }
    std::ifstream stream(part.file, std::ios::binary);
    std::string line;
    std::getline(stream, line);
    while (std::getline(stream, line)) {
      if (stream.eof()) {
        throw InputError(part.file +
                         ": found a last row that is not whole; allowed: a part that "
                         "came to its end");
      }
      const std::size_t number = case_of(part.file, line);
      if (number != next) {
        throw InputError(part.file + ": found case " + std::to_string(number) + " where case " +
                         std::to_string(next) +
                         " should come; allowed: every case of the sweep once");
      }
      ++next;
      line += '\n';
      out.write(line);
    }
  }
  out.commit();
  return next;
}

}  // namespace

std::size_t merge_cases(const std::vector<std::string>& parts, const std::string& target) {
  check_names(parts);
  const auto hdf5 = static_cast<std::size_t>(std::count_if(parts.begin(), parts.end(), is_hdf5));
  if ((hdf5 > 0) != is_hdf5(target) || (hdf5 > 0 && hdf5 < parts.size())) {
    throw InputError("found CSV and HDF5 together; allowed: parts and a file of one format");
  }
  return hdf5 > 0 ? merge_hdf5(parts, target) : merge_csv(parts, target);
}

}  // namespace bbsim::record
