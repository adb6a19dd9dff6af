#include "progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace bbsim::app {

using namespace std::chrono_literals;

namespace {

std::string time_text(double seconds) {
  const bool minutes = seconds > 120, hours = seconds > 7200;
  const char* const unit = hours ? "h" : minutes ? "min" : "s";
  char text[40];
  std::snprintf(text, sizeof text, "%.*f %s", hours ? 1 : 0,
                seconds / (hours     ? 3600
                           : minutes ? 60
                                     : 1),
                unit);
  return text;
}

}  // namespace

Progress::Progress(std::string label, bool quiet, bool lines)
    : label_(std::move(label)),
      bar_(!quiet && isatty(STDERR_FILENO) == 1),
      lines_(lines && !quiet && !bar_),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  clear();
}

void Progress::clear() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

void Progress::update(double fraction, const std::string& detail) {
  if (!bar_ && !lines_) return;
  const Clock::time_point now = Clock::now();
  if (now - start_ < 1s || now - last_ < (bar_ ? 100ms : 60s)) return;
  last_ = now;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string more = detail.empty() ? "" : ", " + detail;
  if (done > 0.01) more += ", " + time_text(elapsed * (1 - done) / done) + " left";
  if (lines_) {
    std::fprintf(stderr, "%s: %.1f%%%s\n", label_.c_str(), 100 * done, more.c_str());
    return;
  }
  drawn_ = true;
  constexpr int width = 30;
  const int filled = static_cast<int>(done * width);
  std::fprintf(stderr, "\r\033[K%s [%.*s%.*s] %3.0f%%%s", label_.c_str(), filled,
               "##############################", width - filled, "..............................",
               100 * done, more.c_str());
  std::fflush(stderr);
}

}  // namespace bbsim::app
