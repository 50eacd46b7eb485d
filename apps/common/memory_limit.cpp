#include "memory_limit.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include "error.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

// The number in the first line of a file; nothing for "max" and for files that are not there.
std::optional<std::uint64_t> number_in(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string word;
  if (!(file >> word)) return std::nullopt;
  const std::optional<std::int64_t> value = parse_integer(word);
  if (!value || *value < 0) return std::nullopt;
  return static_cast<std::uint64_t>(*value);
}

std::uint64_t kernel_available() {
  std::ifstream file("/proc/meminfo");
  std::string line;
  while (std::getline(file, line)) {
    if (line.rfind("MemAvailable:", 0) != 0) continue;
    const auto words = split_words(line);
    const auto kib = words.size() > 1 ? parse_integer(words[1]) : std::nullopt;
    if (kib && *kib >= 0) return static_cast<std::uint64_t>(*kib) * 1024;
  }
  return kUnknown;
}

// What a control group leaves: limit − usage, page cache that can be dropped not counted as usage.
std::uint64_t group_available(const std::filesystem::path& folder, const char* limit_name,
                              const char* usage_name, const std::string& cache_key) {
  const auto limit = number_in(folder / limit_name);
  const auto usage = number_in(folder / usage_name);
  if (!limit || !usage) return kUnknown;
  std::uint64_t cache = 0;
  std::ifstream statistics(folder / "memory.stat");
  std::string key;
  std::uint64_t value = 0;
  while (statistics >> key >> value) {
    if (key == cache_key) cache = value;
  }
  const std::uint64_t used = *usage - std::min(*usage, cache);
  return *limit - std::min(*limit, used);
}

// Control groups of the process, each with its parents: "0::/a/b" (version 2) or "n:memory:/a/b".
std::uint64_t groups_available() {
  std::uint64_t least = kUnknown;
  std::ifstream groups("/proc/self/cgroup");
  std::string line;
  while (std::getline(groups, line)) {
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const bool version_2 = controllers == ",,";
    if (!version_2 && controllers.find(",memory,") == std::string::npos) continue;
    const std::filesystem::path root = version_2 ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    std::filesystem::path group = std::filesystem::path(line.substr(second + 1)).relative_path();
    while (true) {
      least = std::min(
          least,
          version_2 ? group_available(root / group, "memory.max", "memory.current", "inactive_file")
                    : group_available(root / group, "memory.limit_in_bytes",
                                      "memory.usage_in_bytes", "total_inactive_file"));
      if (group.empty()) break;
      group = group.parent_path();
    }
  }
  return least;
}

std::uint64_t address_space_available() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknown;
  const auto pages = number_in("/proc/self/statm");
  const long page = sysconf(_SC_PAGESIZE);
  if (!pages || page <= 0) return kUnknown;
  const std::uint64_t used = *pages * static_cast<std::uint64_t>(page);
  return limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, used);
}

}  // namespace

std::uint64_t available_memory() {
  return std::min({kernel_available(), groups_available(), address_space_available()});
}

void require_memory(const std::filesystem::path& path, std::uint64_t needed, std::uint64_t limit,
                    const std::string& what) {
  const std::uint64_t available = limit == 0 ? available_memory() : limit;
  if (needed <= available) return;
  throw FileError(path, "needs " + bytes_to_text(needed) + " of memory for " + what + ", but " +
                            bytes_to_text(available) + " is available");
}

}  // namespace shape3d::apps
