#pragma once

#include <string>

namespace shape3d::apps {

/// Holds the right to write a file against other processes, by a lock on FILE-lock beside it. The
/// lock ends with the process, however that ends; the destructor removes FILE-lock.
class WriterLock {
 public:
  /// @throws FileError  another process has it; the folder cannot be written.
  explicit WriterLock(const std::string& path);
  ~WriterLock();
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;

 private:
  std::string lock_path_;
  int descriptor_ = -1;
};

}  // namespace shape3d::apps
