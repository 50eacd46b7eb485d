#include "scratch_folder.hpp"

#include <cstdio>
#include <cstdlib>
#include <system_error>

#include <unistd.h>

namespace shape3d::fuzz {
namespace {

class Folder {
 public:
  Folder() : owner_(getpid()) {
    std::error_code error;
    const std::filesystem::path memory = "/dev/shm";
    const bool in_memory = std::filesystem::is_directory(memory, error);
    std::string name =
        (in_memory ? memory : std::filesystem::temp_directory_path()) / "shape3d-fuzz-XXXXXX";
    if (mkdtemp(name.data()) == nullptr) {
      std::perror("mkdtemp");
      std::abort();
    }
    path_ = name;
  }
  ~Folder() {
    if (getpid() != owner_) return;  // a child process that ended in another way
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  pid_t owner_;
  std::filesystem::path path_;
};

}  // namespace

const std::filesystem::path& scratch_folder() {
  static const Folder folder;
  return folder.path();
}

std::vector<std::string_view> split_files(const std::uint8_t* data, std::size_t size) {
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  std::vector<std::string_view> files;
  for (std::size_t end = rest.find(kNextFile); end != std::string_view::npos;
       end = rest.find(kNextFile)) {
    files.push_back(rest.substr(0, end));
    rest.remove_prefix(end + kNextFile.size());
  }
  files.push_back(rest);
  return files;
}

std::filesystem::path write_scratch(std::string_view name, std::string_view bytes) {
  const std::filesystem::path path = scratch_folder() / name;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  const bool written = file != nullptr &&
                       std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() &&
                       std::fclose(file) == 0;
  if (!written) {
    std::perror(path.c_str());
    std::abort();
  }
  return path;
}

void write_scratch(const std::vector<std::string>& names,
                   const std::vector<std::string_view>& files, std::size_t first) {
  for (std::size_t n = first; n < names.size(); ++n) {
    std::error_code error;
    if (n < files.size()) {
      write_scratch(names[n], files[n]);
    } else {
      std::filesystem::remove(scratch_folder() / names[n], error);
    }
  }
}

}  // namespace shape3d::fuzz
