#include "benchmark/generate_dataset.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "advisor/encoding.h"
#include "terrain/digest.h"
#include "terrain/files/dataset.h"
#include "terrain/files/whole_file.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

using terra::testing::ErrorMessage;
using terra::testing::TempFolder;
using ::testing::HasSubstr;
using ::testing::StartsWith;

GenerateOptions SmallOptions(int count) {
  GenerateOptions options;
  options.subsets = {Subset::kEasy, Subset::kHard};
  options.count = count;
  options.seed = 40;
  options.name = "small";
  options.version = "3";
  return options;
}

std::string Read(const std::string& path) {
  return ReadWholeFile(path, std::size_t{1} << 26).value();
}

TEST(GenerateDataset, IsReadBackAsTheGeneratedCases) {
  const TempFolder folder;
  const std::string path = folder.Path("data");
  const Result<std::string> digest = GenerateDataset(SmallOptions(2), path);
  ASSERT_TRUE(digest.ok()) << ErrorMessage(digest);
  const Result<Dataset> dataset = ReadDataset(path);
  ASSERT_TRUE(dataset.ok()) << ErrorMessage(dataset);
  EXPECT_EQ(dataset->name, "small");
  EXPECT_EQ(dataset->version, "3");
  EXPECT_EQ(dataset->digest, *digest);
  ASSERT_EQ(dataset->cases.size(), 4U);
  std::string lines;
  for (std::size_t i = 0; i < 4; ++i) {
    const Subset subset = i < 2 ? Subset::kEasy : Subset::kHard;
    const DatasetCase& c = dataset->cases[i];
    const GeneratedCase drawn = GenerateCase(
        subset, 40, static_cast<int>(i % 2), CalibratedParameters(subset));
    EXPECT_EQ(c.group, SubsetName(subset));
    EXPECT_EQ(c.start, drawn.start);
    EXPECT_EQ(c.goal, drawn.goal);
    const Result<TerrainMap> map = ReadCaseMap(*dataset, c);
    ASSERT_TRUE(map.ok()) << ErrorMessage(map);
    EXPECT_EQ(MapId(*map), MapId(drawn.map));
    lines += DigestLine(c.case_id, MapId(drawn.map), c.start, c.goal);
  }
  EXPECT_EQ(*digest, advisor::Sha256Hex(lines));
}

TEST(GenerateDataset, ASmallerSetIsTheBeginningOfALargerOne) {
  const TempFolder folder;
  GenerateOptions options = SmallOptions(3);
  options.subsets = {Subset::kHard};
  ASSERT_TRUE(GenerateDataset(options, folder.Path("three")).ok());
  options.count = 2;
  options.jobs = 1;
  ASSERT_TRUE(GenerateDataset(options, folder.Path("two")).ok());
  EXPECT_THAT(Read(folder.Path("three/cases.csv")),
              StartsWith(Read(folder.Path("two/cases.csv"))));
  EXPECT_EQ(Read(folder.Path("three/maps/hard_0001.png")),
            Read(folder.Path("two/maps/hard_0001.png")));
}

TEST(GenerateDataset, SumsNameEveryFileWithItsDigest) {
  const TempFolder folder;
  const std::string path = folder.Path("data");
  ASSERT_TRUE(GenerateDataset(SmallOptions(1), path).ok());
  std::ifstream sums(path + "/SHA256SUMS");
  int files = 0;
  std::string sum;
  std::string name;
  while (sums >> sum >> name) {
    EXPECT_EQ(sum, advisor::Sha256Hex(Read(path + "/" + name))) << name;
    ++files;
  }
  EXPECT_EQ(files, 6);  // 4 tables, 2 maps
}

TEST(GenerateDataset, SaysHowItWasMade) {
  const TempFolder folder;
  const std::string path = folder.Path("data");
  ASSERT_TRUE(GenerateDataset(SmallOptions(1), path).ok());
  const auto json = nlohmann::json::parse(Read(path + "/dataset.json"));
  EXPECT_EQ(json["seed"], 40);
  EXPECT_EQ(json["generator_version"], kGeneratorVersion);
  EXPECT_TRUE(json["subsets"]["hard"]["parameters"].contains("polygons"));
  EXPECT_TRUE(json["subsets"]["easy"]["rejections"].contains("end_blocked"));
  EXPECT_THAT(Read(path + "/README.md"), HasSubstr("not the paper's maps"));
}

TEST(GenerateDataset, DoesNotOverwriteADataset) {
  const TempFolder folder;
  const std::string path = folder.Path("data");
  ASSERT_TRUE(GenerateDataset(SmallOptions(1), path).ok());
  EXPECT_THAT(ErrorMessage(GenerateDataset(SmallOptions(1), path)),
              HasSubstr("holds a dataset already"));
}

}  // namespace
}  // namespace terra::benchmark
