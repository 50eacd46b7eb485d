// Draws the pictures of the documentation that show cells.
//
//   shape3d_figures FOLDER

#include <cstdio>
#include <exception>
#include <string>

#include "common/output_file.hpp"
#include "sheets.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: shape3d_figures FOLDER\n", stderr);
    return 2;
  }
  using namespace shape3d::apps;
  try {
    const std::string folder = argv[1];
    const auto write = [&](const std::string& name, const std::string& png) {
      OutputFile file(folder + "/" + name);
      file.write(png);
      file.commit();
      std::printf("%s\n", file.path().c_str());
    };
    write("zmc-case-227.png", draw_preimage_sheet(227));
    write("zmc-face-configurations.png", draw_face_sheet());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
