#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace shape3d::fuzz {

/// A folder of this process, in memory where there is such a file system; removed at its end.
[[nodiscard]] const std::filesystem::path& scratch_folder();

/// An input may be several files, with this between two of them.
inline constexpr std::string_view kNextFile = "\n--next file--\n";

/// The files of an input, at least one.
[[nodiscard]] std::vector<std::string_view> split_files(const std::uint8_t* data, std::size_t size);

/// Writes over the file of this name in the scratch folder.
std::filesystem::path write_scratch(std::string_view name, std::string_view bytes);

/// Writes files[n] as names[n] for n ≥ first, and removes files of the names beyond, so that
/// nothing of another input is there.
void write_scratch(const std::vector<std::string>& names,
                   const std::vector<std::string_view>& files, std::size_t first);

}  // namespace shape3d::fuzz
