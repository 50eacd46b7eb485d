#include "isolated.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

namespace shape3d::apps {
namespace {

constexpr std::size_t kLongestMessage = 1000;

// The child: exit status 0, or 1 with a message in `message`.
[[noreturn]] void run_child(const std::function<void()>& work, std::uint64_t cpu_seconds,
                            std::byte* message) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int sink = open("/dev/null", O_WRONLY);
  dup2(sink, STDOUT_FILENO);
  dup2(sink, STDERR_FILENO);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const rlimit cpu{cpu_seconds, cpu_seconds};
  setrlimit(RLIMIT_CPU, &cpu);
  for (const int number : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL}) std::signal(number, SIG_DFL);
  const char* text = "an unknown error";
  try {
    work();
    _exit(0);
  } catch (const std::bad_alloc&) {
    std::strncpy(reinterpret_cast<char*>(message), "there is not enough memory",
                 kLongestMessage - 1);
    _exit(1);
  } catch (const std::exception& error) {
    std::strncpy(reinterpret_cast<char*>(message), error.what(), kLongestMessage - 1);
    _exit(1);
  } catch (...) {
    std::strncpy(reinterpret_cast<char*>(message), text, kLongestMessage - 1);
    _exit(1);
  }
}

}  // namespace

SharedBytes::SharedBytes(std::size_t size) : size_(size) {
  void* address = mmap(nullptr, std::max<std::size_t>(size, 1), PROT_READ | PROT_WRITE,
                       MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (address == MAP_FAILED) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(address);
}

SharedBytes::~SharedBytes() { munmap(data_, std::max<std::size_t>(size_, 1)); }

std::string run_isolated(const std::function<void()>& work, std::uint64_t cpu_seconds) {
  SharedBytes message(kLongestMessage);
  const pid_t child = fork();
  if (child < 0) return "no child process: " + std::generic_category().message(errno);
  if (child == 0) run_child(work, cpu_seconds, message.data());
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return "lost its child process: " + std::generic_category().message(errno);
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  const std::string text = reinterpret_cast<const char*>(message.data());
  if (!text.empty()) return text;
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    if (number == SIGXCPU || number == SIGKILL) return "decoding took too long";
    return std::string("the decoder crashed (") + strsignal(number) + ")";
  }
  return "the decoder ended without a result";
}

}  // namespace shape3d::apps
