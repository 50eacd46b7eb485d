#include "output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "error.hpp"
#include "interrupt.hpp"

namespace shape3d::apps {
namespace {

namespace fs = std::filesystem;

std::string reason(int error) { return std::strerror(error); }

// Letters that make a name nobody else uses: the number of tries at random bits, checked by O_EXCL.
std::string random_letters() {
  std::random_device device;
  std::string letters;
  for (int i = 0; i < 8; ++i) letters += static_cast<char>('a' + device() % 26);
  return letters;
}

}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)), target_(path_) {
  if (path_.empty()) throw FileError("output file", "the name is empty");
  std::error_code error;
  if (fs::is_symlink(path_, error)) {
    target_ = fs::weakly_canonical(path_, error).string();
    if (error) throw FileError(path_, "the symbolic link cannot be followed: " + error.message());
  }
  struct stat status {};
  const bool exists = stat(target_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) {
    throw FileError(path_, "is a directory, expected the name of a file to write");
  }
  direct_ = exists && !S_ISREG(status.st_mode);
  buffer_ = std::make_unique<char[]>(kCapacity);
  if (direct_) {
    temporary_ = target_;
    descriptor_ = open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) throw FileError(path_, "cannot be written: " + reason(errno));
    return;
  }
  const fs::path parent = fs::path(target_).parent_path();
  const std::string directory = parent.empty() ? "." : parent.string();
  if (!fs::exists(directory, error)) {
    throw FileError(path_, "the directory " + directory + " does not exist");
  }
  if (!fs::is_directory(directory, error))
    throw FileError(path_, directory + " is not a directory");
  // VTK's writers choose nothing by extension, yet a temporary that keeps it is easier to
  // recognise.
  const fs::path name = fs::path(target_).filename();
  for (int attempt = 0; attempt < 16 && descriptor_ < 0; ++attempt) {
    const std::string hidden = "." + name.stem().string().substr(0, 100) + "." + random_letters() +
                               name.extension().string();
    temporary_ = (parent / hidden).string();
    guard_ = std::make_unique<RemoveOnInterrupt>(temporary_);
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) {
      const int code = errno;
      guard_.reset();
      throw FileError(path_, "the directory " + directory + " cannot be written: " + reason(code));
    }
  }
  if (descriptor_ < 0) throw FileError(path_, "no free name for a temporary file in " + directory);
  if (exists) [[maybe_unused]]
    const int kept = fchmod(descriptor_, status.st_mode & 07777);
}

OutputFile::~OutputFile() { abandon(); }

void OutputFile::abandon() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  if (!committed_ && !direct_ && !temporary_.empty()) unlink(temporary_.c_str());
  guard_.reset();
}

void OutputFile::write(const void* data, std::size_t size) {
  if (size == 0) return;  // an empty array may have no address
  const char* bytes = static_cast<const char*>(data);
  if (size >= kCapacity) {
    flush();
    write_through(bytes, size);
    return;
  }
  make_room(size);
  std::memcpy(buffer_.get() + used_, bytes, size);
  used_ += size;
}

void OutputFile::flush() {
  const std::size_t size = std::exchange(used_, 0);
  write_through(buffer_.get(), size);
}

void OutputFile::write_through(const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor_, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw FileError(path_, "cannot be written: " + reason(errno));
    data += written;
    size -= static_cast<std::size_t>(written);
  }
}

void OutputFile::finish() {
  if (descriptor_ < 0) return;
  flush();
  if (close(std::exchange(descriptor_, -1)) != 0) {
    throw FileError(path_, "cannot be written: " + reason(errno));
  }
}

void OutputFile::commit() {
  finish();
  if (!direct_ && std::rename(temporary_.c_str(), target_.c_str()) != 0) {
    throw FileError(path_, "cannot be given its name: " + reason(errno));
  }
  committed_ = true;
  guard_.reset();
}

}  // namespace shape3d::apps
