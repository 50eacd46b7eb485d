#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "shape_library.hpp"

// Parts of shape libraries; of use to shape_library*.cpp only.
namespace shape3d::apps {

class Sqlite;

/// What is stored beside blobs: CRC-32.
[[nodiscard]] std::int64_t check_sum(std::string_view bytes);

/// Why the bytes are not the vector that was stored, as the end of a sentence; empty: they are.
[[nodiscard]] std::string vector_fault(std::string_view bytes, std::int64_t sum,
                                       Eigen::Index length);

/// "the vector of model 7 by egi:K=4,align=none".
[[nodiscard]] std::string vector_name(std::int64_t id, const std::string& spec);

/// As ShapeLibrary::check().
[[nodiscard]] std::vector<LibraryFault> faults_of(const Sqlite& database, bool files);

}  // namespace shape3d::apps
