#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace shape3d::apps {

/// Walks the data elements of a DICOM file, sequences with their items included, and checks that
/// each has a known value representation and a length that fits it and the file. (Parsers that
/// trust elements crash on damaged ones.) Pixel data that are cut off end the walk; behind whole
/// ones there may be further elements, or zeros. Implicit and explicit, little- and big-endian
/// transfer syntaxes; values are not looked at. A deflated data set is refused. Source: DICOM part
/// 5, section 7, and part 10, section 7.
///
/// @param bytes        the file; with or without its preamble of 128 bytes and "DICM".
/// @param is_sequence  for a tag: whether the dictionary knows it as a sequence; nothing when it
/// does not
///                     know it. A known tag must be what the dictionary says.
/// @return a sentence with tag and byte position, empty when nothing is wrong.
[[nodiscard]] std::string check_dicom_elements(
    std::string_view bytes, std::optional<bool> (*is_sequence)(std::uint32_t tag));

}  // namespace shape3d::apps
