#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace shape3d::apps::viewer {

/// A thread that works on requests; of those that come while it is at work, the last one alone
/// comes next.
template <class Request>
class LatestWorker {
 public:
  /// @param work  Called by the thread; does not throw.
  explicit LatestWorker(std::function<void(Request)> work)
      : work_(std::move(work)), thread_([this] { run(); }) {}
  /// Waits for what is under way; what waits is dropped.
  ~LatestWorker() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    changed_.notify_one();
    thread_.join();
  }
  LatestWorker(const LatestWorker&) = delete;
  LatestWorker& operator=(const LatestWorker&) = delete;

  void request(Request request) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      next_ = std::move(request);
    }
    changed_.notify_one();
  }

 private:
  void run() {
    while (true) {
      std::optional<Request> now;
      {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [this] { return ending_ || next_.has_value(); });
        if (ending_) return;
        now = std::exchange(next_, std::nullopt);
      }
      work_(std::move(*now));
    }
  }

  std::function<void(Request)> work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Request> next_;
  bool ending_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace shape3d::apps::viewer
