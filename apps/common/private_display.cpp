#include "private_display.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "interrupt.hpp"

namespace shape3d::apps {
namespace {

constexpr int kPatience = 20'000;  // ms

// Xvfb in the PATH; looked up before fork(), after which only exec and the like are safe.
std::string find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string rest = path != nullptr ? path : "/usr/bin:/bin";
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    const std::string candidate = rest.substr(0, colon) + "/" + name;
    if (access(candidate.c_str(), X_OK) == 0) return candidate;
    rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
  }
  return {};
}

// What the server writes to the pipe, its display number, up to the line end; empty when it ended
// or is late.
std::string read_number(int descriptor) {
  std::string number;
  while (true) {
    pollfd wait{descriptor, POLLIN, 0};
    const int ready = poll(&wait, 1, kPatience);
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return {};
    char c = 0;
    if (read(descriptor, &c, 1) != 1) return {};
    if (c == '\n') return number;
    number += c;
  }
}

}  // namespace

PrivateDisplay::PrivateDisplay() {
  const std::string program = find_program("Xvfb");
  if (program.empty()) {
    throw PictureError(
        "pictures are drawn under Xvfb, which is not installed (Debian package xvfb)");
  }
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0)
    throw PictureError(std::string("no pipe to Xvfb: ") + std::strerror(errno));
  const std::string descriptor = std::to_string(pipe_ends[1]);
  // -noreset: else the server restarts when a window was the only one, and the next finds none.
  const char* arguments[] = {"Xvfb",     "-displayfd",   descriptor.c_str(), "-screen",
                             "0",        "1280x1024x24", "-nolisten",        "tcp",
                             "-noreset", nullptr};
  const pid_t parent = getpid();
  server_ = fork();
  if (server_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(127);
    setpgid(0, 0);  // an interrupt from the terminal is the parent's to pass on
    const int null = open("/dev/null", O_RDWR);
    dup2(null, STDIN_FILENO);
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
    fcntl(pipe_ends[1], F_SETFD, 0);
    std::signal(SIGPIPE, SIG_DFL);
    execv(program.c_str(), const_cast<char* const*>(arguments));
    _exit(127);
  }
  close(pipe_ends[1]);
  if (server_ < 0) {
    close(pipe_ends[0]);
    throw PictureError(std::string("Xvfb could not be started: ") + std::strerror(errno));
  }
  guard_ = std::make_unique<EndOnInterrupt>(server_);
  const std::string number = read_number(pipe_ends[0]);
  close(pipe_ends[0]);
  if (number.empty()) {
    end();
    throw PictureError("Xvfb (" + program + ") was started but offers no display");
  }
  name_ = ":" + number;
}

PrivateDisplay::~PrivateDisplay() { end(); }

void PrivateDisplay::end() {
  if (server_ <= 0) return;
  kill(server_, SIGTERM);
  while (waitpid(server_, nullptr, 0) < 0 && errno == EINTR) {
  }
  guard_.reset();
  server_ = -1;
}

}  // namespace shape3d::apps
