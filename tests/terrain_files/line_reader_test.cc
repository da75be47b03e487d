#include "terrain/files/line_reader.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

using ::testing::ElementsAre;
using testing::ErrorMessage;
using ::testing::HasSubstr;
using testing::TempFolder;

std::vector<std::string> LinesOf(LineReader& reader) {
  std::vector<std::string> lines;
  while (reader.Next().value()) lines.push_back(reader.line());
  return lines;
}

TEST(LineReader, TakesLinesAsTheyStand) {
  const TempFolder folder;
  const std::string path = folder.Write("f", std::string("a\n\n\0b\r\nc", 8));
  auto reader = LineReader::Open(path);
  ASSERT_TRUE(reader.ok()) << ErrorMessage(reader);
  EXPECT_THAT(LinesOf(*reader),
              ElementsAre("a\n", "\n", std::string("\0b\r\n", 4), "c"));
  EXPECT_FALSE(reader->Next().value()) << "the end stays the end";
}

TEST(LineReader, GoesOnFromAPlace) {
  const TempFolder folder;
  const std::string path = folder.Write("f", "one\ntwo\nthree\n");
  auto reader = LineReader::Open(path);
  ASSERT_TRUE(reader.ok()) << ErrorMessage(reader);
  ASSERT_TRUE(reader->Next().value());
  const LineReader::Place second = reader->place();
  EXPECT_EQ(second.offset, 4);
  EXPECT_EQ(second.line, 2);
  LinesOf(*reader);
  reader->GoTo(second);
  EXPECT_THAT(LinesOf(*reader), ElementsAre("two\n", "three\n"));
  EXPECT_EQ(reader->place().line, 4);
}

TEST(LineReader, ALineWithoutAnEndTakesBoundedMemory) {
  const TempFolder folder;
  const std::string path = folder.Write("f", "short\n");
  // A hole of a gigabyte takes no room on the disk.
  std::filesystem::resize_file(path, std::uintmax_t{1} << 30);
  auto reader = LineReader::Open(path);
  ASSERT_TRUE(reader.ok()) << ErrorMessage(reader);
  ASSERT_TRUE(reader->Next().value());
  EXPECT_THAT(ErrorMessage(reader->Next()),
              HasSubstr("f:2: a line of more than 67108864 bytes"));
}

TEST(LineReader, OnlyFilesAreRead) {
  const TempFolder folder;
  EXPECT_THAT(ErrorMessage(LineReader::Open(folder.Path("none"))),
              HasSubstr("there is no such file"));
  EXPECT_THAT(ErrorMessage(LineReader::Open(folder.Path(""))),
              HasSubstr("is not a regular file"));
}

}  // namespace
}  // namespace terra
