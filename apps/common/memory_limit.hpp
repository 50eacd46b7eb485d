#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace shape3d::apps {

/// Bytes this process can still allocate without swapping: the least of what the kernel calls
/// available
/// (/proc/meminfo), what the control groups of the process leave, and what RLIMIT_AS leaves.
/// The largest value when none of them is known.
[[nodiscard]] std::uint64_t available_memory();

/// @param limit  bytes to compare with; 0 stands for available_memory().
/// @param what   what the memory is for: "512 x 512 x 28 int16 samples".
/// @throws FileError  naming path, `what`, the bytes needed and the bytes available.
void require_memory(const std::filesystem::path& path, std::uint64_t needed, std::uint64_t limit,
                    const std::string& what);

}  // namespace shape3d::apps
