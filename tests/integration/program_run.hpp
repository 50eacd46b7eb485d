#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace shape3d::test {

/// How a run of the program ended.
struct Run {
  int status = -1;  ///< Exit status; 128 + n after signal n.
  std::string out, err;
};

struct RunOptions {
  std::filesystem::path folder = ".";              ///< Working directory.
  std::vector<std::string> unset;                  ///< Environment variables to remove.
  std::vector<std::string> set;                    ///< "NAME=value".
  std::uint64_t file_size_limit = 0;               ///< RLIMIT_FSIZE; 0: none.
  std::uint64_t memory_limit = 0;                  ///< RLIMIT_AS; 0: none.
  unsigned user = 0;                               ///< User the program runs as; 0: this one.
  std::function<void(int process)> while_running;  ///< Called once, after the start.
};

/// Runs `shape3d ARGUMENTS…` and waits for it.
Run run_shape3d(const std::vector<std::string>& arguments, const RunOptions& options = {});

/// Writes a MetaImage (.mhd with .raw) of float32 samples f(i, j, k).
void make_volume(const std::filesystem::path& header, const std::array<int, 3>& dims,
                 const std::function<float(int, int, int)>& sample,
                 const std::string& header_lines = {});

/// A sphere of radius r round the centre of n³ samples: positive inside.
std::function<float(int, int, int)> ball(int n, double radius);

std::string slurp(const std::filesystem::path& path);
nlohmann::json read_json(const std::filesystem::path& path);

/// Names of what is in a folder, hidden files too.
std::vector<std::string> listing(const std::filesystem::path& folder);

}  // namespace shape3d::test
