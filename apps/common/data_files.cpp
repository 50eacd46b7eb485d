#include "data_files.hpp"

#include "error.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

void check_count(std::size_t count, const std::filesystem::path& path) {
  if (count > 0 && count <= kMostDataFiles) return;
  throw FileError(path, "names " + std::to_string(count) + " data files; expected 1 to " +
                            std::to_string(kMostDataFiles));
}

// Number with at least `width` characters.
std::string padded(std::int64_t number, std::size_t width, char fill) {
  std::string text = std::to_string(number);
  const std::size_t sign = number < 0 && fill == '0' ? 1 : 0;
  if (text.size() < width) text.insert(sign, width - text.size(), fill);
  return text;
}

}  // namespace

std::vector<std::string> numbered_names(std::string_view pattern, std::int64_t first,
                                        std::int64_t last, std::int64_t step,
                                        const std::filesystem::path& path) {
  const auto bad = [&] {
    return FileError(path,
                     "data file pattern " + in_quotes(pattern) + "; expected one %d, %3d or %03d");
  };
  const std::size_t start = pattern.find('%');
  if (start == std::string_view::npos) throw bad();
  std::size_t end = start + 1;
  const char fill = end < pattern.size() && pattern[end] == '0' ? '0' : ' ';
  std::size_t width = 0;
  while (end < pattern.size() && pattern[end] >= '0' && pattern[end] <= '9' && width < 100) {
    width = 10 * width + static_cast<std::size_t>(pattern[end++] - '0');
  }
  if (width >= 100 || end >= pattern.size() || pattern[end] != 'd' ||
      pattern.find('%', end) != std::string_view::npos) {
    throw bad();
  }
  if (step == 0 || (step > 0) != (last >= first)) {
    throw FileError(path, "data files are numbered from " + std::to_string(first) + " to " +
                              std::to_string(last) + " by " + std::to_string(step));
  }
  // Unsigned differences do not overflow.
  const std::uint64_t span =
      step > 0 ? static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first)
               : static_cast<std::uint64_t>(first) - static_cast<std::uint64_t>(last);
  const std::uint64_t stride =
      step > 0 ? static_cast<std::uint64_t>(step) : 0 - static_cast<std::uint64_t>(step);
  const std::uint64_t count = span / stride;
  if (count >= kMostDataFiles) check_count(kMostDataFiles + 1, path);
  std::vector<std::string> names;
  for (std::uint64_t n = 0; n <= count; ++n) {
    const std::int64_t number = first + static_cast<std::int64_t>(n) * step;
    names.push_back(std::string(pattern.substr(0, start)) + padded(number, width, fill) +
                    std::string(pattern.substr(end + 1)));
  }
  return names;
}

std::vector<std::string> listed_names(std::string_view lines, const std::filesystem::path& path) {
  std::vector<std::string> names;
  while (!lines.empty() && names.size() <= kMostDataFiles) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string_view name = trim(lines.substr(0, end));
    if (!name.empty()) names.emplace_back(name);
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  check_count(names.size(), path);
  return names;
}

}  // namespace shape3d::apps
