#include "progress.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include <unistd.h>

namespace shape3d::apps {
namespace {

constexpr double kPatience = 0.5, kInterval = 0.1;  // seconds

std::string duration(double seconds) {
  std::array<char, 64> text{};
  if (seconds < 60) {
    std::snprintf(text.data(), text.size(), "%.1f s", seconds);
  } else {
    std::snprintf(text.data(), text.size(), "%d min %d s", static_cast<int>(seconds) / 60,
                  static_cast<int>(seconds) % 60);
  }
  return text.data();
}

}  // namespace

Progress::Progress(const Settings& settings)
    : active_(!settings.quiet && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() { clear(); }

void Progress::stage(std::string name) {
  clear();
  name_ = std::move(name);
  stage_watch_.lap();
}

void Progress::update(double share, double left) {
  const double passed = stage_watch_.seconds();
  if (!active_ || passed < kPatience || (shown_ && shown_watch_.seconds() < kInterval)) return;
  std::string line =
      name_ + ": " + std::to_string(static_cast<int>(100 * share)) + " %, " + duration(passed);
  if (std::isnan(left) && share > 0.02) left = passed * (1 - share) / share;
  if (!std::isnan(left)) line += ", about " + duration(left) + " left";
  show(line);
}

void Progress::show(const std::string& line) {
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
  shown_ = true;
  shown_watch_.lap();
}

void Progress::clear() {
  if (!shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace shape3d::apps
