#include "terminal.hpp"

#include <cstdio>
#include <new>

#include "base/printable.hpp"
#include "file/atomic_file.hpp"

namespace bbsim::app {

void say(std::string_view message) {
  try {
    const std::string line = printable(message) + '\n';
    // Written in one piece, so that it stays whole among those of other processes.
    static_cast<void>(std::fwrite(line.data(), 1, line.size(), stderr));
  } catch (const std::bad_alloc&) {
    std::fputs("out of memory\n", stderr);
  }
}

void print(const std::string& report) {
  file::write_file("-", printable(report));
}

}  // namespace bbsim::app
