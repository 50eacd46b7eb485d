#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace shape3d::bench {

/// Another program, to which lines are written and from which lines are read. It ends, at the end
/// of its input, with this object.
class LineProcess {
 public:
  /// @param command  Program and its arguments; no shell is involved.
  /// @throws std::system_error  it cannot be started.
  explicit LineProcess(const std::vector<std::string>& command);
  ~LineProcess();
  LineProcess(const LineProcess&) = delete;
  LineProcess& operator=(const LineProcess&) = delete;

  void write_line(const std::string& line);
  /// The next line without its end; nothing when the program has ended.
  [[nodiscard]] std::optional<std::string> read_line();

 private:
  pid_t process_ = -1;
  std::FILE* to_ = nullptr;
  std::FILE* from_ = nullptr;
};

}  // namespace shape3d::bench
