#pragma once

#include <charconv>
#include <cstddef>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

namespace shape3d::apps {

class RemoveOnInterrupt;

/// A file that appears under its name only when it is complete.
///
/// The bytes go to a temporary file in the same directory; commit() renames it. Unless committed,
/// the destructor (and an interrupt) removes it, and an existing file of that name stays as it was.
/// A symbolic link is followed; a device or pipe is written directly. Every failure is a FileError
/// that names the path and what the system says.
class OutputFile {
 public:
  /// Creates the temporary file.
  /// @throws FileError  the directory does not exist, is not a directory or not writable; the path
  /// is empty or
  ///         is a directory.
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  /// Where the bytes are until commit(), for writers that open a file themselves.
  [[nodiscard]] const std::string& temporary_path() const { return temporary_; }

  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// The shortest decimal that reads back as the same number.
  template <class Number>
  void write_number(Number number) {
    make_room(32);
    used_ = static_cast<std::size_t>(
        std::to_chars(buffer_.get() + used_, buffer_.get() + kCapacity, number).ptr -
        buffer_.get());
  }
  void write_char(char c) {
    make_room(1);
    buffer_[used_++] = c;
  }
  /// The bytes of a number in native order.
  template <class Number>
  void write_binary(Number number) {
    make_room(sizeof number);
    std::memcpy(buffer_.get() + used_, &number, sizeof number);
    used_ += sizeof number;
  }

  /// Flushes and closes. @throws FileError  the disk is full, the size limit is reached …
  void finish();
  /// finish(), then gives the file its name. @throws FileError  as finish(), or renaming failed.
  void commit();

 private:
  static constexpr std::size_t kCapacity = std::size_t{1} << 18;

  void make_room(std::size_t size) {
    if (used_ + size > kCapacity) flush();
  }
  void flush();
  void write_through(const char* data, std::size_t size);
  void abandon();

  std::string path_, target_, temporary_;
  std::unique_ptr<RemoveOnInterrupt> guard_;
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
  int descriptor_ = -1;
  bool direct_ = false, committed_ = false;
};

}  // namespace shape3d::apps
