#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>

namespace shape3d::apps {

/// Bytes in order, from a file, from memory or out of a compressed stream.
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  /// Reads up to `count` bytes; fewer only where the source ends.
  virtual std::size_t read(void* out, std::size_t count) = 0;
};

/// Size of a regular file that can be read.
/// @throws FileError  it does not exist, is a directory, a device or a pipe, or cannot be opened
/// (with the
///         system's reason).
[[nodiscard]] std::uint64_t readable_size(const std::filesystem::path& path);

/// A regular file from a byte offset on.
class FileSource final : public ByteSource {
 public:
  /// @throws FileError  as readable_size().
  explicit FileSource(const std::filesystem::path& path, std::uint64_t offset = 0);
  /// @throws FileError  the system reports an error.
  std::size_t read(void* out, std::size_t count) override;

 private:
  std::filesystem::path path_;
  std::ifstream file_;
};

/// Bytes that outlive the source.
class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::string_view bytes) : rest_(bytes) {}
  std::size_t read(void* out, std::size_t count) override;

 private:
  std::string_view rest_;
};

/// What a gzip or zlib stream holds (which of them is seen from its first bytes). Gzip members one
/// after another are one stream; bytes after the last member are ignored, as gzip does.
class InflateSource final : public ByteSource {
 public:
  /// @param path  names the file in messages.
  InflateSource(std::unique_ptr<ByteSource> source, const std::filesystem::path& path);
  ~InflateSource() override;
  /// Fewer bytes at the end of the stream, and where its input ends too early: then truncated().
  /// @throws FileError  damaged data: no header, an impossible code, a wrong check sum.
  std::size_t read(void* out, std::size_t count) override;

  /// True when the input ended inside a stream.
  [[nodiscard]] bool truncated() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A file's bytes without reading those that are not looked at.
class MappedFile {
 public:
  /// @throws FileError  as readable_size().
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::string_view bytes() const { return bytes_; }

 private:
  std::string_view bytes_;
};

/// The first `count` bytes of a file, or all of it when it is shorter.
/// @throws FileError  as readable_size().
[[nodiscard]] std::string read_head(const std::filesystem::path& path, std::size_t count);

/// True when the bytes begin like a gzip stream.
[[nodiscard]] bool begins_like_gzip(std::string_view bytes);

}  // namespace shape3d::apps
