#include "mesh_io.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "error.hpp"
#include "memory_limit.hpp"
#include "mesh_formats.hpp"

namespace shape3d::apps {
namespace {

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ >= 0) close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return value_; }

 private:
  int value_;
};

struct Bytes {
  std::unique_ptr<char[]> data;
  std::size_t size = 0;
};

Bytes read_file(const std::string& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0)
    throw FileError(path, std::string("cannot be opened: ") + std::strerror(errno));
  struct stat status {};
  if (fstat(file.get(), &status) != 0)
    throw FileError(path, std::string("cannot be read: ") + std::strerror(errno));
  if (S_ISDIR(status.st_mode)) throw FileError(path, "is a directory, expected a mesh file");
  if (!S_ISREG(status.st_mode)) throw FileError(path, "is not a regular file");
  Bytes bytes;
  bytes.size = static_cast<std::size_t>(status.st_size);
  if (bytes.size == 0) throw FileError(path, "is empty, expected a mesh");
  require_memory(path, bytes.size, 0, "the bytes of the file");
  bytes.data.reset(new char[bytes.size]);
  for (std::size_t at = 0; at < bytes.size;) {
    const ssize_t got = read(file.get(), bytes.data.get() + at, bytes.size - at);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw FileError(path, std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) throw FileError(path, "became shorter while it was read");
    at += static_cast<std::size_t>(got);
  }
  return bytes;
}

}  // namespace

std::string_view to_string(MeshFormat format) {
  switch (format) {
    case MeshFormat::off:
      return "OFF";
    case MeshFormat::obj:
      return "OBJ";
    case MeshFormat::ply:
      return "PLY";
    case MeshFormat::stl:
      return "STL";
    case MeshFormat::vtp:
      return "VTP";
  }
  return "unknown";
}

std::optional<MeshFormat> mesh_format(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".off") return MeshFormat::off;
  if (extension == ".obj") return MeshFormat::obj;
  if (extension == ".ply") return MeshFormat::ply;
  if (extension == ".stl") return MeshFormat::stl;
  if (extension == ".vtp") return MeshFormat::vtp;
  return std::nullopt;
}

std::string unknown_mesh_extension(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return (extension.empty() ? std::string("has no extension")
                            : "unknown extension '" + extension + "'") +
         ", expected .ply, .obj, .off, .stl or .vtp";
}

MeshFile read_mesh(const std::string& path) {
  const std::optional<MeshFormat> format = mesh_format(path);
  if (!format) throw FileError(path, unknown_mesh_extension(path));
  const Bytes bytes = read_file(path);
  return parse_mesh({bytes.data.get(), bytes.size}, *format, path);
}

MeshFile parse_mesh(std::string_view bytes, MeshFormat format, const std::string& name) {
  if (bytes.empty()) throw FileError(name, "is empty, expected a mesh");
  switch (format) {
    case MeshFormat::off:
      return formats::parse_off(bytes, name);
    case MeshFormat::obj:
      return formats::parse_obj(bytes, name);
    case MeshFormat::ply:
      return formats::parse_ply(bytes, name);
    case MeshFormat::stl:
      return formats::parse_stl(bytes, name);
    case MeshFormat::vtp:
      return formats::parse_vtp(bytes, name);
  }
  throw FileError(name, "unknown mesh format");
}

void write_mesh(OutputFile& file, MeshFormat format, const MeshView& mesh, MeshEncoding encoding) {
  switch (format) {
    case MeshFormat::off:
      return formats::write_off(file, mesh);
    case MeshFormat::obj:
      return formats::write_obj(file, mesh);
    case MeshFormat::ply:
      return formats::write_ply(file, mesh, encoding);
    case MeshFormat::stl:
      return formats::write_stl(file, mesh, encoding);
    case MeshFormat::vtp:
      return formats::write_vtp(file, mesh);
  }
}

void write_mesh(const std::string& path, const MeshView& mesh, MeshEncoding encoding) {
  const std::optional<MeshFormat> format = mesh_format(path);
  if (!format) throw FileError(path, unknown_mesh_extension(path));
  OutputFile file(path);
  write_mesh(file, *format, mesh, encoding);
  file.commit();
}

}  // namespace shape3d::apps
