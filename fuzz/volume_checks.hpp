#pragma once

#include <string>
#include <utility>

#include "check.hpp"
#include "common/error.hpp"
#include "common/volume_info.hpp"
#include "common/volume_io.hpp"
#include "shape3d/zmc/volume_view.hpp"

namespace shape3d::fuzz {

/// Memory that a volume may take, as a header announces it.
inline constexpr std::uint64_t kVolumeMemory = std::uint64_t{1} << 26;

/// A message names its file and is printable.
inline void check_message(const apps::FileError& error) {
  const std::string text = error.what();
  const std::string path = apps::printable(error.path().string());
  check(!path.empty() && text.rfind(path + ": ", 0) == 0, "an error names its file: " + text);
  check(text.size() > path.size() + 4, "an error has a sentence: " + text);
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    check((byte >= 32 && byte != 127) || c == '\n', "an error is printable: " + text);
  }
}

/// A volume that was read is whole.
inline void check_volume(const apps::Volume& volume) {
  zmc::validate(volume.view);
  std::size_t bytes = zmc::sample_size(volume.view.type);
  for (const std::int64_t n : volume.view.dims) bytes *= static_cast<std::size_t>(n);
  check(volume.samples.size() == bytes && volume.view.data == volume.samples.data(),
        "a volume holds its samples");
  const apps::VolumeDescription description = describe_volume(volume);
  std::uint64_t counted = 0;
  for (const std::uint64_t n : description.histogram) counted += n;
  check(counted == description.finite && description.finite + description.non_finite ==
                                             bytes / zmc::sample_size(volume.view.type),
        "each sample is counted once");
  check(description.minimum <= description.mean && description.mean <= description.maximum,
        "the mean lies within the range");
}

/// Reads; either the volume is whole or a FileError says why not.
template <class Read>
void read_or_refuse(const Read& read) {
  try {
    check_volume(read());
  } catch (const apps::FileError& error) {
    check_message(error);
  }
}

}  // namespace shape3d::fuzz
