// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The sources of sketches: the search for functions and included headers. A NUL ends a file of the
// sketch and begins the next one.
#include <algorithm>

#include "fuzz.hpp"
#include "sketch/source.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace bbsim::sketch;
  using bbsim_fuzz::must;
  std::string_view text = bbsim_fuzz::text_of(data, size);
  std::vector<SketchFile> files;
  do {
    const std::size_t end = std::min(text.find('\0'), text.size());
    files.push_back(
        {"a\"" + std::to_string(files.size()) + ".ino", std::string(text.substr(0, end))});
    text.remove_prefix(std::min(end + 1, text.size()));
  } while (!text.empty());
  const std::string source = joined(files);
  // Prototypes and lines are added; nothing of the sketch is lost.
  std::size_t own = 0;
  for (const SketchFile& file : files) {
    own += file.text.size();
    for (const std::string& header : includes_of(file.text)) must(header.size() < file.text.size());
  }
  must(source.size() >= own);
  must(joined(files) == source);
  return 0;
}
