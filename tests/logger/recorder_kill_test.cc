// A recorder whose file the kernel lets grow to a byte and no further, for each
// byte of what it writes (in CI, some): killed there, or refused like a disk
// that is full.
#include <signal.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "logger/log_info.h"
#include "logger/recorder.h"
#include "tests/support/temp_folder.h"

namespace terra::logger {
namespace {

using testing::TempFolder;

constexpr std::int64_t kNow = 1'800'000'000'000'000;
// Each byte takes some syncs of a disk.
#ifdef TERRA_EVERY_BYTE
constexpr rlim_t kStep = 1;
#else
constexpr rlim_t kStep = 37;
#endif
constexpr int kFlushes = 4;
constexpr int kEventsPerFlush = 3;
constexpr int kEvents = kFlushes * kEventsPerFlush;

void LimitFilesTo(rlim_t bytes) {
  const rlimit limit{bytes, RLIM_INFINITY};
  setrlimit(RLIMIT_FSIZE, &limit);
}

void RecordSome(Recorder& recorder) {
  for (int i = 0; i < kEventsPerFlush; ++i) {
    recorder.Record({kNow, "CAMERA", std::vector<std::uint8_t>(40, 7)});
  }
}

// In the child: says after each Flush how many events are acknowledged.
[[noreturn]] void RecordUntilKilled(const std::string& folder, int said_to) {
  auto recorder = Recorder::Start(folder, RecorderOptions{}, kNow);
  for (int i = 0; recorder && i < kFlushes; ++i) {
    RecordSome(*recorder);
    if (!recorder->Flush(kNow)) _exit(3);
    const std::int64_t acknowledged = recorder->acknowledged_events();
    if (write(said_to, &acknowledged, sizeof acknowledged) < 0) _exit(3);
  }
  _exit(0);
}

struct Outcome {
  int status = 0;  // Of waitpid.
  std::int64_t acknowledged = 0;
};

// Returns what the recorder had acknowledged when it was killed at a byte.
Outcome KilledAt(rlim_t bytes, const std::string& folder) {
  std::array<int, 2> ends{};
  EXPECT_EQ(pipe(ends.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_DFL);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    LimitFilesTo(bytes);
    RecordUntilKilled(folder, ends[1]);
  }
  close(ends[1]);
  Outcome outcome;
  std::int64_t said = 0;
  while (read(ends[0], &said, sizeof said) == sizeof said) {
    outcome.acknowledged = said;
  }
  close(ends[0]);
  waitpid(child, &outcome.status, 0);
  return outcome;
}

// The only file in a folder; empty when there is none.
std::string FileIn(const std::string& folder) {
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    return entry.path().string();
  }
  return {};
}

rlim_t WholeSize() {
  const TempFolder folder;
  KilledAt(RLIM_INFINITY, folder.Path("log"));
  return std::filesystem::file_size(FileIn(folder.Path("log")));
}

TEST(RecorderKilled, AtAnyByteOfAWriteKeepsAllThatItAcknowledged) {
  const rlim_t size = WholeSize();
  ASSERT_GT(size, 1'000U);
  std::int64_t torn = 0;
  for (rlim_t at = 1; at < size; at += kStep) {
    const TempFolder folder;
    const Outcome outcome = KilledAt(at, folder.Path("log"));
    ASSERT_TRUE(WIFSIGNALED(outcome.status)) << "at byte " << at;
    Result<LogReader> reader = LogReader::Open(FileIn(folder.Path("log")));
    ASSERT_TRUE(reader.ok()) << "at byte " << at;
    const LogInfo info = Inspect(*reader);
    EXPECT_GE(info.events, outcome.acknowledged) << "at byte " << at;
    EXPECT_EQ(info.num_broken_seals, 0) << "at byte " << at;
    EXPECT_FALSE(info.closed);
    EXPECT_LE(info.damage.size(), 1U) << "at byte " << at;
    for (const LogDamage& damage : info.damage) {
      EXPECT_TRUE(damage.torn_end) << "at byte " << at;
      ++torn;
    }
  }
  EXPECT_GT(torn, 0);
}

// In the child: a disk that is full at a byte, and has room later.
int RecordOverAFullDisk(rlim_t bytes, const std::string& folder) {
  signal(SIGXFSZ, SIG_IGN);
  auto recorder = Recorder::Start(folder, RecorderOptions{}, kNow);
  if (!recorder) return 2;
  LimitFilesTo(bytes);
  int refused = 0;
  for (int i = 0; i < kFlushes; ++i) {
    RecordSome(*recorder);
    if (recorder->Flush(kNow)) continue;
    ++refused;
    // What is on the disk meanwhile is whole, without a torn event.
    Result<LogReader> reader = LogReader::Open(recorder->path());
    const LogInfo info = Inspect(*reader);
    if (!info.intact() || info.events < recorder->acknowledged_events()) {
      return 3;
    }
  }
  LimitFilesTo(RLIM_INFINITY);
  return refused > 0 && recorder->Close(kNow).ok() && recorder->lost() == 0 ? 0
                                                                            : 4;
}

TEST(RecorderRefused, AtAnyByteOfAWriteLosesNothingOnceThereIsRoom) {
  const rlim_t size = WholeSize();
  const TempFolder empty;
  const auto started =
      Recorder::Start(empty.Path("log"), RecorderOptions{}, kNow);
  const rlim_t first = std::filesystem::file_size(started->path());
  for (rlim_t at = first; at < size; at += kStep) {
    const TempFolder folder;
    const pid_t child = fork();
    if (child == 0) _exit(RecordOverAFullDisk(at, folder.Path("log")));
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
        << "at byte " << at << ": " << WEXITSTATUS(status);
    Result<LogReader> reader = LogReader::Open(FileIn(folder.Path("log")));
    const LogInfo info = Inspect(*reader);
    EXPECT_TRUE(info.intact() && info.closed) << "at byte " << at;
    EXPECT_EQ(info.channels.at("CAMERA").events, kEvents);
  }
}

}  // namespace
}  // namespace terra::logger
