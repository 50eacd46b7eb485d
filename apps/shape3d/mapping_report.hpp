#pragma once

#include <string>

#include <shape3d/mapping/align.hpp>
#include <shape3d/mapping/inspect.hpp>
#include <shape3d/mapping/repair.hpp>
#include <shape3d/mapping/wrap.hpp>

#include "report.hpp"

namespace shape3d::apps {

/// How sentences name the remedies on the command line.
inline constexpr const char *kRepairOption = "--repair", *kWrapOption = "--wrap";

[[nodiscard]] Json to_json(const Eigen::Ref<const Eigen::MatrixXd>& matrix);  ///< Row after row.
[[nodiscard]] Json to_json(const mapping::Inspection& inspection);
[[nodiscard]] Json to_json(const mapping::RepairSummary& summary);
[[nodiscard]] Json to_json(const mapping::Wrapped& wrapped);
[[nodiscard]] Json to_json(const mapping::Pose& pose);

/// Lines for a person.
[[nodiscard]] std::string to_lines(const mapping::Pose& pose);

/// Warns of each finding that does not prevent a map.
void warn_of(const std::string& path, const mapping::Inspection& inspection,
             const Settings& settings);

}  // namespace shape3d::apps
