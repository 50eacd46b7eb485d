#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace shape3d::apps {

/// File names of a printf-like pattern with one integer conversion (%d, %3d, %03d …) for first,
/// first + step … up to last, as NRRD and MetaImage headers give them.
/// @throws FileError  no or another conversion, a step of 0, no names or more than kMostDataFiles.
[[nodiscard]] std::vector<std::string> numbered_names(std::string_view pattern, std::int64_t first,
                                                      std::int64_t last, std::int64_t step,
                                                      const std::filesystem::path& path);

/// The non-empty lines of a text: a list of file names.
/// @throws FileError  there are none or more than kMostDataFiles.
[[nodiscard]] std::vector<std::string> listed_names(std::string_view lines,
                                                    const std::filesystem::path& path);

constexpr std::size_t kMostDataFiles = 100000;

}  // namespace shape3d::apps
