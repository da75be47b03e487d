// What a path may name, and what becomes of it.
#include "output/output_file.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

namespace fs = std::filesystem;
using testing::ErrorMessage;
using ::testing::HasSubstr;
using testing::ReadBytes;
using testing::TempFolder;

constexpr uid_t kSomebody = 12'345;

struct stat StatOf(const std::string& path) {
  struct stat status = {};
  EXPECT_EQ(::lstat(path.c_str(), &status), 0) << path;
  return status;
}
mode_t ModeOf(const std::string& path) {
  return StatOf(path).st_mode & 07777;
}

std::size_t NumFiles(const TempFolder& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder.Path("")), {}));
}

// Runs `work` in a process of an unprivileged user where the test is root.
// Returns its exit code, 128 + n when signal n ended it.
template <typename Work>
int InAnotherProcess(uid_t user, Work work) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (::geteuid() == 0 && user != 0 &&
        (::setgid(user) != 0 || ::setuid(user) != 0)) {
      ::_exit(99);
    }
    ::_exit(work());
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

TEST(OutputFile, ANewFileHasItsContentAndTheUsualPermissions) {
  const TempFolder folder;
  const std::string path = folder.Path("new");
  const mode_t before = ::umask(027);
  const Status written = WriteWholeFile(path, "content");
  ::umask(before);
  ASSERT_TRUE(written.ok()) << ErrorMessage(written);
  EXPECT_EQ(ReadBytes(path), "content");
  EXPECT_EQ(ModeOf(path), 0640U);
  EXPECT_EQ(NumFiles(folder), 1U);
}

TEST(OutputFile, AReaderSeesTheOldContentUntilTheEnd) {
  const TempFolder folder;
  const std::string path = folder.Write("file", "old");
  Result<OutputFile> file = OutputFile::Create(path);
  ASSERT_TRUE(file.ok()) << ErrorMessage(file);
  const std::string large(200'000, 'x');
  file->Write("begin");
  file->Write(large);
  file->Write("end");
  EXPECT_EQ(ReadBytes(path), "old");
  ASSERT_TRUE(file->Finish().ok());
  EXPECT_EQ(ReadBytes(path), "begin" + large + "end");
  EXPECT_EQ(NumFiles(folder), 1U);
}

TEST(OutputFile, WithoutFinishNothingHappened) {
  const TempFolder folder;
  const std::string path = folder.Write("file", "old");
  {
    Result<OutputFile> file = OutputFile::Create(path);
    ASSERT_TRUE(file.ok());
    file->Write(std::string(200'000, 'x'));
    EXPECT_EQ(NumFiles(folder), 2U) << "in the same folder";
  }
  EXPECT_EQ(ReadBytes(path), "old");
  EXPECT_EQ(NumFiles(folder), 1U);
}

TEST(OutputFile, TwoWritersOfOneFileDoNotMeet) {
  const TempFolder folder;
  const std::string path = folder.Path("file");
  Result<OutputFile> a = OutputFile::Create(path);
  Result<OutputFile> b = OutputFile::Create(path);
  ASSERT_TRUE(a.ok() && b.ok());
  a->Write("from a");
  b->Write("b");
  ASSERT_TRUE(a->Finish().ok());
  EXPECT_EQ(ReadBytes(path), "from a");
  ASSERT_TRUE(b->Finish().ok());
  EXPECT_EQ(ReadBytes(path), "b");
}

TEST(OutputFile, TheLongestNameThereIsCanBeWritten) {
  const TempFolder folder;
  const std::string path = folder.Path(std::string(255, 'n'));
  const Status written = WriteWholeFile(path, "x");
  EXPECT_TRUE(written.ok()) << ErrorMessage(written);
  EXPECT_EQ(ReadBytes(path), "x");
}

TEST(OutputFile, PermissionsStay) {
  for (const mode_t mode : {0600U, 0640U, 0666U, 0755U}) {
    const TempFolder folder;
    const std::string path = folder.Write("file", "old");
    ASSERT_EQ(::chmod(path.c_str(), mode), 0);
    ASSERT_TRUE(WriteWholeFile(path, "new").ok());
    EXPECT_EQ(ReadBytes(path), "new");
    EXPECT_EQ(ModeOf(path), mode);
  }
}

TEST(OutputFile, RootKeepsOwnerGroupAndAReadOnlyFileReadOnly) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root may give files away";
  const TempFolder folder;
  const std::string path = folder.Write("file", "old");
  ASSERT_EQ(::chown(path.c_str(), kSomebody, kSomebody + 1), 0);
  ASSERT_EQ(::chmod(path.c_str(), 0444), 0);
  ASSERT_TRUE(WriteWholeFile(path, "new").ok());
  EXPECT_EQ(ReadBytes(path), "new");
  EXPECT_EQ(ModeOf(path), 0444U);
  EXPECT_EQ(StatOf(path).st_uid, kSomebody);
  EXPECT_EQ(StatOf(path).st_gid, kSomebody + 1);
}

TEST(OutputFile, AGroupThatCannotBeKeptGivesNoRightsToAnother) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root may give files away";
  const TempFolder folder;
  ASSERT_EQ(::chmod(folder.Path("").c_str(), 0777), 0);
  const std::string path = folder.Write("file", "old");
  ASSERT_EQ(::chown(path.c_str(), kSomebody, kSomebody + 1), 0);
  ASSERT_EQ(::chmod(path.c_str(), 0664), 0);
  EXPECT_EQ(InAnotherProcess(kSomebody,
                             [&] {
                               return WriteWholeFile(path, "new").ok() ? 0 : 1;
                             }),
            0);
  EXPECT_EQ(ReadBytes(path), "new");
  EXPECT_EQ(ModeOf(path), 0644U) << "its group is another one now";
}

TEST(OutputFile, WhatMayNotBeWrittenIsRefusedAndStays) {
  const TempFolder folder;
  ASSERT_EQ(::chmod(folder.Path("").c_str(), 0777), 0);
  const std::string path = folder.Write("file", "old");
  ASSERT_EQ(::chmod(path.c_str(), 0444), 0);
  if (::geteuid() == 0) {
    ASSERT_EQ(::chown(path.c_str(), kSomebody, kSomebody), 0);
  }
  const auto write = [&] {
    return ErrorMessage(WriteWholeFile(path, "new")) ==
                   path + ": cannot be written: Permission denied"
               ? 0
               : 1;
  };
  EXPECT_EQ(InAnotherProcess(kSomebody, write), 0);
  EXPECT_EQ(ReadBytes(path), "old");
  EXPECT_EQ(ModeOf(path), 0444U);
  EXPECT_EQ(NumFiles(folder), 1U);
}

TEST(OutputFile, AFolderThatTakesNoFileIsNamed) {
  const TempFolder folder;
  ASSERT_EQ(::chmod(folder.Path("").c_str(), 0555), 0);
  const std::string path = folder.Path("file");
  const auto write = [&] {
    const std::string message = ErrorMessage(WriteWholeFile(path, "new"));
    return message == path + ": cannot be written: Permission denied (folder " +
                          fs::path(path).parent_path().string() + ")"
               ? 0
               : 1;
  };
  EXPECT_EQ(InAnotherProcess(kSomebody, write), 0);
}

TEST(OutputFile, AFolderAndAMissingFolderAreRefused) {
  const TempFolder folder;
  EXPECT_THAT(ErrorMessage(WriteWholeFile(folder.Path(""), "x")),
              HasSubstr("cannot be written: Is a directory"));
  EXPECT_THAT(ErrorMessage(WriteWholeFile(folder.Path("no/file"), "x")),
              HasSubstr("no/file: cannot be written: No such file"));
  EXPECT_FALSE(WriteWholeFile("", "x").ok());
}

TEST(OutputFile, LinksStayAndTheirTargetsAreWritten) {
  const TempFolder folder;
  const std::string target = folder.Write("deep/target", "old");
  ASSERT_EQ(::chmod(target.c_str(), 0600), 0);
  const std::string link = folder.Path("link");
  const std::string link_to_link = folder.Path("deep/again");
  fs::create_symlink("deep/target", link);
  fs::create_symlink("../link", link_to_link);
  for (const std::string& path : {link, link_to_link}) {
    ASSERT_TRUE(WriteWholeFile(path, path).ok());
    EXPECT_EQ(ReadBytes(target), path);
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_TRUE(fs::is_symlink(link_to_link));
    EXPECT_EQ(ModeOf(target), 0600U);
  }
  EXPECT_EQ(NumFiles(folder), 2U);
}

TEST(OutputFile, ALinkToNothingMakesItsTarget) {
  const TempFolder folder;
  const std::string link = folder.Path("link");
  fs::create_symlink("target", link);
  ASSERT_TRUE(WriteWholeFile(link, "x").ok());
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(ReadBytes(folder.Path("target")), "x");
}

TEST(OutputFile, LinksInACircleAreAnError) {
  const TempFolder folder;
  fs::create_symlink("b", folder.Path("a"));
  fs::create_symlink("a", folder.Path("b"));
  EXPECT_THAT(ErrorMessage(WriteWholeFile(folder.Path("a"), "x")),
              HasSubstr("Too many levels of symbolic links"));
}

TEST(OutputFile, APipeIsWrittenThroughAndStaysOne) {
  const TempFolder folder;
  const std::string path = folder.Path("pipe");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const std::string content(300'000, 'p');
  std::string read;
  std::thread reader([&] {
    read = ReadBytes(path);
  });
  EXPECT_TRUE(WriteWholeFile(path, content).ok());
  reader.join();
  EXPECT_EQ(read, content);
  EXPECT_TRUE(S_ISFIFO(StatOf(path).st_mode));
  EXPECT_EQ(NumFiles(folder), 1U);
}

// A device of the test's own with the numbers of /dev/null or /dev/full. Empty
// where this user or this file system allows none.
std::string DeviceIn(const TempFolder& folder, unsigned minor) {
  const std::string path = folder.Path("device");
  if (::mknod(path.c_str(), S_IFCHR | 0666, (1U << 8) | minor) != 0) return "";
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return "";
  ::close(fd);
  return path;
}

TEST(OutputFile, ADeviceIsWrittenThroughAndStaysOne) {
  const TempFolder folder;
  const std::string path = DeviceIn(folder, 3);
  if (path.empty()) GTEST_SKIP() << "no device can be made here";
  EXPECT_TRUE(WriteWholeFile(path, "x").ok());
  EXPECT_TRUE(S_ISCHR(StatOf(path).st_mode));
  EXPECT_EQ(NumFiles(folder), 1U);
}

TEST(OutputFile, AFullDeviceIsAnError) {
  const TempFolder folder;
  const std::string path = DeviceIn(folder, 7);
  if (path.empty()) GTEST_SKIP() << "no device can be made here";
  EXPECT_THAT(ErrorMessage(WriteWholeFile(path, "x")),
              HasSubstr("device: cannot be written: No space left on device"));
  EXPECT_TRUE(S_ISCHR(StatOf(path).st_mode));
}

TEST(OutputFile, AnOpenDescriptorIsWrittenWhereItStands) {
  const TempFolder folder;
  const std::string path = folder.Write("log", "before\n");
  const int fd = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  ASSERT_GE(fd, 0);
  const Status written =
      WriteWholeFile("/dev/fd/" + std::to_string(fd), "new\n");
  ::close(fd);
  ASSERT_TRUE(written.ok()) << ErrorMessage(written);
  EXPECT_EQ(ReadBytes(path), "before\nnew\n") << "as the shell's >> wants it";
  EXPECT_EQ(NumFiles(folder), 1U);
}

TEST(OutputFile, AFailureInTheMiddleLeavesTheOldFileAlone) {
  const TempFolder folder;
  const std::string path = folder.Write("file", "old");
  const auto write = [&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {100'000, 100'000};
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 2;
    const Status written = WriteWholeFile(path, std::string(200'000, 'x'));
    return ErrorMessage(written).find("File too large") != std::string::npos
               ? 0
               : 1;
  };
  EXPECT_EQ(InAnotherProcess(0, write), 0);
  EXPECT_EQ(ReadBytes(path), "old");
  EXPECT_EQ(NumFiles(folder), 1U);
}

}  // namespace
}  // namespace terra
