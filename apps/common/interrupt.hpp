#pragma once

#include <string>

#include <sys/types.h>

namespace shape3d::apps {

/// Makes SIGINT and SIGTERM end the process at once with exit status 130 and 143, after removing
/// the files and ending the processes listed below; ignores SIGPIPE and SIGXFSZ, so that a closed
/// pipe and a file size limit are reported as errors of write(). Call once, first thing in main().
void install_interrupt_handler();

/// While it lives, an interrupt removes this file. Beyond 64 at a time, or for a path of 4096 bytes
/// or more, the file is not listed.
class RemoveOnInterrupt {
 public:
  explicit RemoveOnInterrupt(const std::string& path);
  ~RemoveOnInterrupt();
  RemoveOnInterrupt(const RemoveOnInterrupt&) = delete;
  RemoveOnInterrupt& operator=(const RemoveOnInterrupt&) = delete;

 private:
  int slot_ = -1;
};

/// While it lives, an interrupt ends this child process.
class EndOnInterrupt {
 public:
  explicit EndOnInterrupt(pid_t process);
  ~EndOnInterrupt();
  EndOnInterrupt(const EndOnInterrupt&) = delete;
  EndOnInterrupt& operator=(const EndOnInterrupt&) = delete;

 private:
  int slot_ = -1;
};

}  // namespace shape3d::apps
