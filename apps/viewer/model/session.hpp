#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace shape3d::apps::viewer {

/// All that the viewer shows, as its session file holds it.
struct Session {
  std::vector<std::string> files;  ///< Absolute paths, in the order of opening.
  std::string view = "volume";     ///< Name of the view in front.
  bool dark = true;
  /// What each view says of itself, by its name; views that this program does not have are kept.
  nlohmann::json views = nlohmann::json::object();
};

/// The text of a session file: JSON with "format": "shape3d-viewer session", "version": 1. Paths
/// below the folder of the file are written relative to it, so that a folder can be moved.
/// @param path  Where it will be written.
[[nodiscard]] std::string session_text(const Session& session, const std::string& path);

/// Reads a session file.
/// @throws FileError  it cannot be read; it is no JSON (the sentence names the byte); "format" or
///         "version" is another; a member is missing or of another type.
[[nodiscard]] Session read_session(const std::string& path);

/// Writes one, whole or not at all.
/// @throws FileError  as OutputFile does.
void write_session(const std::string& path, const Session& session);

}  // namespace shape3d::apps::viewer
