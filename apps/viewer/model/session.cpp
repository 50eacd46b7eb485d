#include "session.hpp"

#include <filesystem>

#include "common/byte_source.hpp"
#include "common/error.hpp"
#include "common/output_file.hpp"
#include "common/text.hpp"

namespace shape3d::apps::viewer {
namespace {

using Json = nlohmann::json;
constexpr std::string_view kFormat = "shape3d-viewer session";
constexpr int kVersion = 1;

std::filesystem::path folder_of(const std::string& path) {
  return std::filesystem::absolute(path).parent_path();
}

const Json& member(const Json& object, const char* name, Json::value_t type,
                   const std::string& expected, const std::string& path) {
  const auto found = object.find(name);
  if (found == object.end())
    throw FileError(path, std::string("has no \"") + name + "\"; expected " + expected);
  const bool number = type == Json::value_t::number_integer && found->is_number_integer();
  if (found->type() != type && !number)
    throw FileError(path,
                    std::string("\"") + name + "\" is " + found->dump() + "; expected " + expected);
  return *found;
}

}  // namespace

std::string session_text(const Session& session, const std::string& path) {
  const std::filesystem::path folder = folder_of(path);
  Json files = Json::array();
  for (const std::string& file : session.files) {
    const std::filesystem::path relative = std::filesystem::path(file).lexically_relative(folder);
    const bool below = !relative.empty() && *relative.begin() != "..";
    files.push_back(below ? relative.string() : file);
  }
  Json json;
  json["format"] = kFormat;
  json["version"] = kVersion;
  json["files"] = files;
  json["view"] = session.view;
  json["dark"] = session.dark;
  json["views"] = session.views;
  return json.dump(2) + "\n";
}

Session read_session(const std::string& path) {
  std::string text(readable_size(path), '\0');
  text.resize(FileSource(path).read(text.data(), text.size()));
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw FileError(path, "is no session: not JSON at byte " + std::to_string(error.byte));
  }
  if (!json.is_object()) throw FileError(path, "is no session: expected a JSON object");
  const std::string format =
      member(json, "format", Json::value_t::string, "\"" + std::string(kFormat) + "\"", path);
  if (format != kFormat)
    throw FileError(
        path, "\"format\" is " + in_quotes(format) + "; expected \"" + std::string(kFormat) + "\"");
  const Json& version =
      member(json, "version", Json::value_t::number_integer, std::to_string(kVersion), path);
  if (version != kVersion)
    throw FileError(path,
                    "\"version\" is " + version.dump() + "; expected " + std::to_string(kVersion));
  Session session;
  for (const Json& file : member(json, "files", Json::value_t::array, "a list of paths", path)) {
    if (!file.is_string())
      throw FileError(path, "\"files\" holds " + file.dump() + "; expected paths");
    const std::filesystem::path name = file.get<std::string>();
    session.files.push_back(
        (name.is_absolute() ? name : folder_of(path) / name).lexically_normal().string());
  }
  session.view = member(json, "view", Json::value_t::string, "the name of a view", path);
  session.dark = member(json, "dark", Json::value_t::boolean, "true or false", path);
  session.views = member(json, "views", Json::value_t::object, "an object", path);
  return session;
}

void write_session(const std::string& path, const Session& session) {
  OutputFile file(path);
  file.write(session_text(session, path));
  file.commit();
}

}  // namespace shape3d::apps::viewer
