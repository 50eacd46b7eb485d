#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shape3d/descriptors/parameters.hpp"

namespace shape3d::descriptors::detail {

/// A descriptor's parameters and its alignment.
struct Description {
  Parameters parameters;
  Align align = Align::none;
};

/// "hsh", "csm" …
std::string_view kind_of(const Parameters& parameters);

/// Keys and values of a description in canonical order; the last is "align".
std::vector<std::pair<std::string, std::string>> fields_of(const Description& description);

/// Reads SPEC as Descriptor::parse() says.
Description parse_description(std::string_view spec);

}  // namespace shape3d::descriptors::detail
