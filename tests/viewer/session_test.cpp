#include "viewer/model/session.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

#include <catch2/catch.hpp>

#include "common/error.hpp"

namespace {
using namespace shape3d::apps;
using namespace shape3d::apps::viewer;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

// Takes a folder away when the process ends.
struct Remover {
  fs::path folder;
  ~Remover() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    fs::remove_all(folder.string() + "-moved", ignored);
  }
};

// One a process: test cases run side by side.
fs::path fresh_folder() {
  const fs::path folder =
      fs::temp_directory_path() / ("shape3d-session-test-" + std::to_string(getpid()));
  static const Remover remover{folder};
  fs::remove_all(folder);
  fs::create_directories(folder / "data");
  return folder;
}

TEST_CASE("a session reads back as it was written", "[viewer][session]") {
  const fs::path folder = fresh_folder();
  Session session;
  session.files = {(folder / "data" / "a.mha").string(), "/elsewhere/b.off"};
  session.view = "surface";
  session.dark = false;
  session.views = {{"surface", {{"isovalue", 226.5}}}, {"unknown", {1, 2}}};
  const std::string path = (folder / "s.json").string();
  write_session(path, session);
  const Session read = read_session(path);
  CHECK(read.files == session.files);
  CHECK(read.view == session.view);
  CHECK(read.dark == session.dark);
  CHECK(read.views == session.views);
}

TEST_CASE("files below a session's folder move with it", "[viewer][session]") {
  const fs::path folder = fresh_folder();
  Session session;
  session.files = {(folder / "data" / "a.mha").string()};
  write_session((folder / "s.json").string(), session);
  const fs::path moved = folder.string() + "-moved";
  fs::remove_all(moved);
  fs::rename(folder, moved);
  CHECK(read_session((moved / "s.json").string()).files ==
        std::vector<std::string>{(moved / "data" / "a.mha").string()});
}

TEST_CASE("what is no session is refused with the reason", "[viewer][session]") {
  const fs::path folder = fresh_folder();
  const std::string path = (folder / "s.json").string();
  const auto refusal = [&path](const std::string& text) -> std::string {
    std::ofstream(path) << text;
    try {
      static_cast<void>(read_session(path));
    } catch (const FileError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string head = R"("format": "shape3d-viewer session", "version": 1)";
  CHECK_THAT(refusal("{\"a\": }"), Contains("not JSON at byte 7"));
  CHECK_THAT(refusal("[1]"), Contains("expected a JSON object"));
  CHECK_THAT(refusal("{}"), Contains("has no \"format\""));
  CHECK_THAT(refusal(R"({"format": "other", "version": 1})"), Contains("\"format\" is \"other\""));
  CHECK_THAT(refusal(R"({"format": "shape3d-viewer session", "version": 2})"),
             Contains("\"version\" is 2; expected 1"));
  CHECK_THAT(refusal("{" + head + "}"), Contains("has no \"files\""));
  CHECK_THAT(refusal("{" + head + R"(, "files": [3]})"), Contains("\"files\" holds 3"));
  CHECK_THAT(refusal("{" + head + R"(, "files": [], "view": 1})"),
             Contains("\"view\" is 1; expected the name of a view"));
  CHECK_THAT(refusal("{" + head + R"(, "files": [], "view": "volume", "dark": 0, "views": {}})"),
             Contains("\"dark\" is 0; expected true or false"));
  CHECK_THAT(refusal("{" + head + R"(, "files": [], "view": "volume", "dark": true, "views": []})"),
             Contains("\"views\" is []; expected an object"));
  CHECK(refusal("{" + head + R"(, "files": [], "view": "volume", "dark": true, "views": {}})") ==
        "accepted");
  CHECK_THROWS_AS(read_session((folder / "none.json").string()), FileError);
  CHECK_THROWS_AS(write_session((folder / "no" / "s.json").string(), Session{}), FileError);
}

}  // namespace
