#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shape3d::apps {

/// Without leading and trailing spaces, tabs, line ends and NUL bytes.
[[nodiscard]] std::string_view trim(std::string_view text);

/// ASCII letters in lower case, everything else as it is.
[[nodiscard]] std::string lower_case(std::string_view text);

/// The words between spaces, tabs and line ends.
[[nodiscard]] std::vector<std::string_view> split_words(std::string_view text);

/// The whole text as a number, with or without sign; "nan" and "inf" are reals. Independent of the
/// locale; nothing when the text is not a number or does not fit the type.
[[nodiscard]] std::optional<double> parse_real(std::string_view text);
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view text);
[[nodiscard]] std::optional<std::uint64_t> parse_unsigned(std::string_view text);

/// Shortest text that reads back as the same double: 0.1, 3, 1e+30, nan.
[[nodiscard]] std::string to_text(double value);

/// "512 x 512 x 28".
[[nodiscard]] std::string to_text(const std::array<std::int64_t, 3>& dims);

/// "17 bytes", "1.5 GiB".
[[nodiscard]] std::string bytes_to_text(std::uint64_t bytes);

/// Foreign text inside double quotes, cut after 60 characters, unprintable bytes as '?'.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace shape3d::apps
