#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string>

#include <shape3d/zmc/options.hpp>

#include "common/volume.hpp"
#include "program.hpp"
#include "progress.hpp"

namespace shape3d::apps {

/// The arguments that extract, contours and compare have in common.
struct VolumeArguments {
  std::string path;
  std::string series;
  zmc::Inside inside = zmc::Inside::above;
  zmc::TieRule ties = zmc::TieRule::neutral;
  zmc::NonFinite non_finite = zmc::NonFinite::error;
};

void add_volume_options(CLI::App& command, VolumeArguments& arguments);
/// "--space lps|ras".
void add_space_option(CLI::App& command, std::string& space);

/// The options of extraction that the arguments and settings say.
[[nodiscard]] zmc::Options to_options(const VolumeArguments& arguments, const Settings& settings);

/// Reads the volume; its warnings go to standard error.
[[nodiscard]] Volume read_volume_of(const VolumeArguments& arguments, const Settings& settings,
                                    Progress& progress);

/// What the library found wrong with a volume, as an error of its file in words of the command
/// line.
[[noreturn]] void fail_for(const std::string& path, const std::invalid_argument& error);

/// Least and greatest finite sample; empty when there is none.
[[nodiscard]] std::optional<std::array<double, 2>> range_of(const zmc::VolumeView& view);

/// "the isovalue 5000 is outside the range -1024 … 3071 of skull.mhd: the surface is empty".
[[nodiscard]] std::string emptiness(const std::string& what, double isovalue,
                                    const zmc::VolumeView& view, const std::string& path);

/// Shortest decimal that reads back as the same number.
[[nodiscard]] std::string shortest(double number);

[[nodiscard]] std::string to_string(zmc::Inside inside);
[[nodiscard]] std::string to_string(zmc::TieRule ties);

}  // namespace shape3d::apps
