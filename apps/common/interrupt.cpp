#include "interrupt.hpp"

#include <atomic>
#include <csignal>
#include <cstring>

#include <unistd.h>

namespace shape3d::apps {
namespace {

// A signal handler may touch only lock-free atomics and memory that was complete before they were
// set.
enum SlotState : int { kFree, kFilling, kListed };

struct FileSlot {
  std::atomic<int> state{kFree};
  char path[4096];
};
struct ProcessSlot {
  std::atomic<int> state{kFree};
  pid_t process;
};

constexpr int kSlots = 64;
FileSlot file_slots[kSlots];
ProcessSlot process_slots[kSlots];
static_assert(std::atomic<int>::is_always_lock_free);

template <class Slot>
int take(Slot* slots) {
  for (int i = 0; i < kSlots; ++i) {
    int expected = kFree;
    if (slots[i].state.compare_exchange_strong(expected, kFilling)) return i;
  }
  return -1;
}

extern "C" void clean_and_exit(int signal) {
  for (FileSlot& slot : file_slots) {
    if (slot.state.load() == kListed) unlink(slot.path);
  }
  for (ProcessSlot& slot : process_slots) {
    if (slot.state.load() == kListed) kill(slot.process, SIGTERM);
  }
  constexpr char kMessage[] = "\nshape3d: interrupted; nothing unfinished was left.\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
  _exit(128 + signal);
}

}  // namespace

void install_interrupt_handler() {
  struct sigaction action {};
  action.sa_handler = clean_and_exit;
  sigfillset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

RemoveOnInterrupt::RemoveOnInterrupt(const std::string& path) {
  if (path.size() >= sizeof file_slots[0].path) return;
  slot_ = take(file_slots);
  if (slot_ < 0) return;
  std::memcpy(file_slots[slot_].path, path.c_str(), path.size() + 1);
  file_slots[slot_].state.store(kListed);
}

RemoveOnInterrupt::~RemoveOnInterrupt() {
  if (slot_ >= 0) file_slots[slot_].state.store(kFree);
}

EndOnInterrupt::EndOnInterrupt(pid_t process) {
  slot_ = take(process_slots);
  if (slot_ < 0) return;
  process_slots[slot_].process = process;
  process_slots[slot_].state.store(kListed);
}

EndOnInterrupt::~EndOnInterrupt() {
  if (slot_ >= 0) process_slots[slot_].state.store(kFree);
}

}  // namespace shape3d::apps
