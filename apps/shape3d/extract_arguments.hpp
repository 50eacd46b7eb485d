#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <shape3d/zmc/options.hpp>

#include "common/mesh_io.hpp"
#include "volume_options.hpp"

namespace shape3d::apps {

/// The command line of `shape3d extract`.
struct ExtractArguments {
  VolumeArguments volume;
  std::vector<double> isovalues;
  std::string output;
  zmc::Triangulation triangulation = zmc::Triangulation::compact;
  zmc::ZeroFaces zero_faces = zmc::ZeroFaces::boundary;
  std::vector<std::int64_t> roi;  ///< Empty, or x0 x1 y0 y1 z0 z1, half-open.
  bool cap = false;
  std::string space = "lps";
  std::string picture;
  std::string id_bits = "auto";
};

/// Extracts, checks, writes, draws and reports.
/// @throws UsageError, FileError, PictureError
void extract_surfaces(const ExtractArguments& arguments, const Settings& settings);

/// The block of a view that --roi says.
/// @throws UsageError  naming the axis, the indices and the samples there are; fewer than two
/// samples.
[[nodiscard]] zmc::VolumeView region_of(const zmc::VolumeView& view,
                                        const std::vector<std::int64_t>& roi);

/// "bone.ply" for one isovalue, "bone_226.ply", "bone_-300.ply" for several; a single name when the
/// format holds them all (VTP).
[[nodiscard]] std::vector<std::string> output_names(const std::string& output,
                                                    const std::vector<double>& isovalues,
                                                    MeshFormat format);

}  // namespace shape3d::apps
