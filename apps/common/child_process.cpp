#include "child_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <new>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "interrupt.hpp"

namespace shape3d::apps {
namespace {

void write_all(int descriptor, const std::string& bytes) {
  const char* at = bytes.data();
  std::size_t left = bytes.size();
  while (left > 0) {
    const ssize_t written = write(descriptor, at, left);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) _exit(2);
    at += written;
    left -= static_cast<std::size_t>(written);
  }
}

std::string read_all(int descriptor) {
  std::string bytes;
  char buffer[65536];
  while (true) {
    const ssize_t got = read(descriptor, buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return bytes;
    bytes.append(buffer, static_cast<std::size_t>(got));
  }
}

[[noreturn]] void run_child(const std::function<std::string()>& function, std::uint64_t cpu_seconds,
                            int descriptor) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  if (cpu_seconds > 0) {
    const rlimit cpu{cpu_seconds, cpu_seconds};
    setrlimit(RLIMIT_CPU, &cpu);
  }
  // An interrupt cleans up in the parent; here it only ends the copy.
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  for (const int number : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL}) std::signal(number, SIG_DFL);
  const int null = open("/dev/null", O_RDWR);
  dup2(null, STDOUT_FILENO);
  dup2(null, STDERR_FILENO);
  std::string result;
  try {
    result = "+" + function();
  } catch (const std::bad_alloc&) {
    result = "-there is not enough memory";
  } catch (const std::exception& error) {
    result = std::string("-") + error.what();
  }
  write_all(descriptor, result);
  _exit(0);
}

}  // namespace

ChildResult run_in_child(const std::function<std::string()>& function, std::uint64_t cpu_seconds) {
  ChildResult result;
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) {
    result.error = std::string("no pipe: ") + std::strerror(errno);
    return result;
  }
  const pid_t child = fork();
  if (child == 0) {
    close(pipe_ends[0]);
    run_child(function, cpu_seconds, pipe_ends[1]);
  }
  close(pipe_ends[1]);
  if (child < 0) {
    close(pipe_ends[0]);
    result.error = std::string("no process: ") + std::strerror(errno);
    return result;
  }
  const EndOnInterrupt guard(child);
  const std::string bytes = read_all(pipe_ends[0]);
  close(pipe_ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) {
    result.error = "ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
                   strsignal(WTERMSIG(status)) + ")";
  } else if (bytes.empty() || WEXITSTATUS(status) != 0) {
    result.error = "ended with exit status " + std::to_string(WEXITSTATUS(status));
  } else if (bytes[0] == '+') {
    result.ok = true;
    result.output = bytes.substr(1);
  } else {
    result.error = bytes.substr(1);
  }
  return result;
}

}  // namespace shape3d::apps
