#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shape3d::apps {

/// A piece of compressed pixel data in its file.
struct Fragment {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
};

/// The fragments of encapsulated pixel data without the offset table before them (DICOM part 5,
/// A.4).
/// @param offset  position of the first item's tag.
/// @return nothing when the file ends before the data do or holds something else there.
[[nodiscard]] std::optional<std::vector<Fragment>> find_fragments(const std::filesystem::path& path,
                                                                  std::uint64_t offset);

/// What the frames of compressed pixel data must be.
struct FrameSize {
  std::uint64_t frames = 1;
  std::uint64_t pixels = 0;  ///< Of a frame.
  std::size_t bytes_per_pixel = 1;
};

/// Looks for damage that decoders do not survive or notice: too few fragments; RLE segments (part
/// 5, annex G) whose number, places or decoded lengths do not fit the image; JPEG data without
/// their marker.
/// @return a sentence, empty when nothing is wrong.
[[nodiscard]] std::string check_fragments(const std::filesystem::path& path,
                                          const std::string& transfer_syntax,
                                          const std::vector<Fragment>& fragments,
                                          const FrameSize& size);

}  // namespace shape3d::apps
