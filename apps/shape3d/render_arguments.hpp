#pragma once

#include <string>
#include <vector>

#include "common/picture.hpp"
#include "program.hpp"

namespace shape3d::apps {

struct RenderArguments {
  std::vector<std::string> meshes;
  std::string sheet;  ///< A folder, instead of meshes.
  std::string output;
  std::string size;  ///< Empty: 1000x1000, or what a sheet needs.
  std::vector<std::string> colors;
  std::vector<double> opacities;
  std::string view;  ///< Empty: front, or what suits each mesh of a sheet.
  std::string background = "white";
  bool largest = false;
  bool offscreen = false;
};

/// Size, view, background and display. @throws UsageError
[[nodiscard]] PictureOptions picture_options(const RenderArguments& arguments);

/// By name. @throws UsageError  naming the option.
[[nodiscard]] Color color_of(const std::string& option, const std::string& name);

/// Draws all meshes of a folder on one page, with their names.
void render_sheet(const RenderArguments& arguments, const Settings& settings);

}  // namespace shape3d::apps
