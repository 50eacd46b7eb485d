#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "byte_source.hpp"
#include "samples.hpp"
#include "volume.hpp"
#include "volume_header.hpp"

namespace shape3d::apps {

/// Samples of a checked header as the host stores them (its byte order), x fastest.
///
/// @param header_path   resolves header.payload.files and names the file in messages.
/// @param memory_limit  bytes that may be used; 0: what the machine has.
/// @throws FileError  a data file is missing or its length is not what the header says (the message
/// has
///         both numbers), a compressed stream ends early, is damaged or holds more, a text sample
///         is no number or does not fit the type, more memory than there is. Lengths are checked
///         before memory is taken, and memory before it is allocated.
[[nodiscard]] std::vector<std::byte> read_payload(const VolumeHeader& header,
                                                  const std::filesystem::path& header_path,
                                                  std::uint64_t memory_limit);

/// Decimal numbers from a source until `count` samples of `type` are in `out` (count × size bytes).
/// @throws FileError  as above.
void read_text_samples(ByteSource& source, StoredType type, std::uint64_t count, std::byte* out,
                       const std::filesystem::path& path);

/// The volume of a header and its samples, which are already scaled.
[[nodiscard]] Volume make_volume(VolumeHeader header, TypedSamples samples);

/// Checks the header, reads its samples and scales them.
/// @throws FileError  as check_header(), read_payload() and convert_samples().
[[nodiscard]] Volume load_volume(VolumeHeader header, const std::filesystem::path& header_path,
                                 std::uint64_t memory_limit);

}  // namespace shape3d::apps
