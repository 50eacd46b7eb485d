#include "writer_lock.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "error.hpp"

namespace shape3d::apps {

WriterLock::WriterLock(const std::string& path) : lock_path_(path + "-lock") {
  for (;;) {
    descriptor_ = open(lock_path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      throw FileError(path, "cannot be written: " + std::string(std::strerror(errno)));
    }
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      close(descriptor_);
      throw FileError(path, "is being written by another process; try again when it has ended");
    }
    // The holder before may have removed the file between open() and flock().
    struct stat held {
    }, named{};
    if (fstat(descriptor_, &held) == 0 && stat(lock_path_.c_str(), &named) == 0 &&
        held.st_ino == named.st_ino && held.st_dev == named.st_dev) {
      return;
    }
    close(descriptor_);
  }
}

WriterLock::~WriterLock() {
  unlink(lock_path_.c_str());
  close(descriptor_);
}

}  // namespace shape3d::apps
