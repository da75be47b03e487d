// What is left when a signal ends the process.
#include "output/temporary_file.h"

#include <signal.h>
#include <unistd.h>

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "output/output_file.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

namespace fs = std::filesystem;

// Who runs tests in the background has two of them ignored; before any test, as
// the program looks once.
const bool kAsFromATerminal = [] {
  for (const int signal : {SIGINT, SIGQUIT}) ::signal(signal, SIG_DFL);
  return true;
}();

// A process that has files half written gets a signal. Returns what ended it.
int SignalOfTheEnd(const testing::TempFolder& folder, int signal,
                   bool ignored = false) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (ignored) ::signal(signal, SIG_IGN);
    std::vector<OutputFile> files;
    for (int i = 0; i < 3; ++i) {
      Result<OutputFile> file =
          OutputFile::Create(folder.Path("file" + std::to_string(i)));
      if (!file.ok()) ::_exit(2);
      file->Write(std::string(100'000, 'x'));
      files.push_back(*std::move(file));
    }
    ::raise(signal);
    for (OutputFile& file : files) {
      if (!file.Finish().ok()) ::_exit(3);
    }
    ::_exit(0);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFSIGNALED(status) ? WTERMSIG(status) : -WEXITSTATUS(status);
}

TEST(TemporaryFile, ASignalThatEndsTheProcessLeavesNothing) {
  ASSERT_TRUE(kAsFromATerminal);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE}) {
    const testing::TempFolder folder;
    folder.Write("file0", "old");
    EXPECT_EQ(SignalOfTheEnd(folder, signal), signal);
    EXPECT_EQ(testing::ReadBytes(folder.Path("file0")), "old");
    EXPECT_FALSE(fs::exists(folder.Path("file1")));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.Path("")), {}), 1)
        << "signal " << signal;
  }
}

TEST(TemporaryFile, AnIgnoredSignalStaysIgnored) {
  const testing::TempFolder folder;  // As nohup does.
  EXPECT_EQ(SignalOfTheEnd(folder, SIGHUP, true), 0);
  EXPECT_TRUE(fs::exists(folder.Path("file2")));
}

TEST(TemporaryFile, ManyAtOnceGoWithTheirObjects) {
  const testing::TempFolder folder;
  {
    std::vector<TemporaryFile> files;  // More than a signal would remove.
    for (int i = 0; i < 300; ++i) {
      auto file = TemporaryFile::Create(folder.Path("file"), 0600);
      ASSERT_TRUE(file.ok());
      files.push_back(*std::move(file));
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.Path("")), {}), 300);
  }
  EXPECT_TRUE(fs::is_empty(folder.Path("")));
}

}  // namespace
}  // namespace terra
