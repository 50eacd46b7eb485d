#include "view.hpp"

#include <algorithm>
#include <filesystem>

#include "document.hpp"

namespace shape3d::apps::viewer {

void View::look_at(Document& document, const std::string& path) {
  if (!std::filesystem::exists(path)) {
    emit failed(QString::fromStdString(
        path + ": is not there any more; 'shape3d library add' of its new place finds it again"));
    return;
  }
  const auto& meshes = document.meshes();
  const bool is_open = std::any_of(meshes.begin(), meshes.end(),
                                   [&path](const auto& mesh) { return mesh->path == path; });
  document.look_at(path);
  if (!is_open) emit wants_file(QString::fromStdString(path));
  emit wants_view("surface");
}

}  // namespace shape3d::apps::viewer
