#pragma once

#include <string>
#include <string_view>

#include "feature_table.hpp"

// The single formats of feature tables; of use to feature_table.cpp only.
namespace shape3d::apps::formats {

void write_csv(OutputFile& file, const FeatureTable& table);
void write_npy(OutputFile& file, const FeatureTable& table);
void write_h5(OutputFile& file, const FeatureTable& table);

FeatureTable parse_csv(std::string_view bytes, const std::string& path);
FeatureTable parse_npy(std::string_view bytes, const std::string& path);
FeatureTable read_h5(const std::string& path);

}  // namespace shape3d::apps::formats
