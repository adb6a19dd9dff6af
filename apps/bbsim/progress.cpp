#include "progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace bbsim::app {

using namespace std::chrono_literals;

Progress::Progress(std::string label, bool quiet)
    : label_(std::move(label)),
      on_(!quiet && isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  clear();
}

void Progress::clear() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

void Progress::update(double fraction) {
  if (!on_) return;
  const Clock::time_point now = Clock::now();
  if (now - start_ < 1s || now - last_ < 100ms) return;
  last_ = now;
  drawn_ = true;
  constexpr int width = 30;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(done * width);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r\033[K%s [%.*s%.*s] %3.0f%%", label_.c_str(), filled,
               "##############################", width - filled, "..............................",
               100 * done);
  if (done > 0.01) std::fprintf(stderr, ", %.0f s left", elapsed * (1 - done) / done);
  std::fflush(stderr);
}

}  // namespace bbsim::app
