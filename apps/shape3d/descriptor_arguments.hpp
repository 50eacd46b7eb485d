#pragma once

#include <string>
#include <vector>

#include <shape3d/descriptors/descriptor.hpp>

namespace shape3d::apps {

/// The descriptors of `--descriptor SPEC`, given once or more.
/// @throws UsageError  one cannot be understood, or is given twice.
[[nodiscard]] std::vector<descriptors::Descriptor> parse_descriptors(
    const std::vector<std::string>& specs);

}  // namespace shape3d::apps
