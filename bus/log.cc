#include "bus/log.h"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <thread>

#include <spdlog/async_logger.h>
#include <spdlog/details/null_mutex.h>
#include <spdlog/details/thread_pool.h>
#include <spdlog/sinks/base_sink.h>

namespace terra::bus {
namespace {

// Writes with write(2) alone: a stdio stream that is stuck in a write would
// keep its lock, and the end of the process would wait for it.
class StandardError
    : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 public:
  std::int64_t handled() const { return handled_; }
  std::int64_t refused() const { return refused_; }

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    if (!Write(line.data(), line.size())) ++refused_;
    ++handled_;
  }
  void flush_() override {}

  static bool Write(const char* at, std::size_t left) {
    while (left > 0) {
      const ssize_t written = write(STDERR_FILENO, at, left);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      at += written;
      left -= static_cast<std::size_t>(written);
    }
    return true;
  }

  std::atomic<std::int64_t> handled_{0};
  std::atomic<std::int64_t> refused_{0};
};

// Blocks all signals for the calling thread while it exists. Threads started
// meanwhile inherit that, so no signal is ever delivered to them.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_{};
};

class Log {
 public:
  // Never destroyed: the writing thread may be stuck in write(2) for ever, and
  // a destructor would wait for it.
  static Log& Instance() {
    static Log* const log = [] {
      auto* const made = new Log;
      std::atexit([] {
        Instance().AwaitWritten();
      });
      return made;
    }();
    return *log;
  }

  void SetName(const std::string& name) {
    auto logger = std::make_shared<spdlog::async_logger>(
        name, sink_, queue_, spdlog::async_overflow_policy::overrun_oldest);
    logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %n %l: %v");
    const std::lock_guard lock(mutex_);
    logger_ = std::move(logger);
  }

  void Write(spdlog::level::level_enum level, const std::string& text) {
    std::shared_ptr<spdlog::async_logger> logger;
    {
      const std::lock_guard lock(mutex_);
      logger = logger_;
    }
    ++queued_;
    logger->log(level, "{}", text);
  }

  std::int64_t Dropped() {
    return sink_->refused() +
           static_cast<std::int64_t>(queue_->overrun_counter());
  }

 private:
  Log() {
    const SignalsBlocked blocked;
    queue_ =
        std::make_shared<spdlog::details::thread_pool>(kMaxQueuedLogLines, 1);
    SetName("terra");
  }

  void AwaitWritten() {
    const auto end = std::chrono::steady_clock::now() +
                     std::chrono::milliseconds(kLogEndWaitMs);
    while (queued_ > sink_->handled() +
                         static_cast<std::int64_t>(queue_->overrun_counter()) &&
           std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  const std::shared_ptr<StandardError> sink_ =
      std::make_shared<StandardError>();
  std::shared_ptr<spdlog::details::thread_pool> queue_;
  std::mutex mutex_;  // guards logger_
  std::shared_ptr<spdlog::async_logger> logger_;
  std::atomic<std::int64_t> queued_{0};
};

}  // namespace

void LogInfo(const std::string& text) {
  Log::Instance().Write(spdlog::level::info, text);
}
void LogWarning(const std::string& text) {
  Log::Instance().Write(spdlog::level::warn, text);
}
void LogError(const std::string& text) {
  Log::Instance().Write(spdlog::level::err, text);
}

void SetLogName(const std::string& name) {
  Log::Instance().SetName(name);
}

std::int64_t LogLinesDropped() {
  return Log::Instance().Dropped();
}

}  // namespace terra::bus
