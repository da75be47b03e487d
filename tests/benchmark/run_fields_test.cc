// Every field of run.json has its place, and every title follows from them.
#include "benchmark/run_fields.h"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "advisor/prompt.h"
#include "benchmark/llm_method.h"
#include "benchmark/method.h"
#include "benchmark/run_labels.h"
#include "terrain/builtin_legends.h"
#include "terrain/files/whole_file.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

using nlohmann::json;
using terra::testing::ErrorMessage;
using terra::testing::TempFolder;
using ::testing::HasSubstr;

class RunFieldsTest : public ::testing::Test {
 protected:
  // What terra bench run would write of a model that is asked in this way.
  RunDescription Described(const std::string& backend,
                           const LlmMethodForm& form = {}) {
    advisor::LlmBackendOptions options;
    options.service.backend = backend;
    options.service.exchange_folder = folder_.Path("exchange");
    options.service.recording = TERRA_TEST_DATA "/recordings/advisor-32.jsonl";
    for (const char* key :
         {"OPENAI_API_KEY", "GEMINI_API_KEY", "ANTHROPIC_API_KEY"}) {
      ::setenv(key, "none", 0);
    }
    if (backend == "chat") {
      options.service.provider.base_url = "http://127.0.0.1:1/v1";
    }
    const auto made = MakeLlmMethod(options, form);
    EXPECT_TRUE(made.ok()) << ErrorMessage(made);
    const DatasetFolder dataset{"", "d", "1", "", "", MultiTerraPathLegend()};
    RunDescription d = DescribeRun(
        dataset, {4, "list", "maps"}, {},
        {made->choice, folder_.Path("out"), made->settings_json}, {});
    d.models = {"gpt-5.5-2026-04-23"};
    d.recorded = {"2026-01-31T23:59:59Z", "2026-01-31T23:59:59Z"};
    return d;
  }

  json Written(const RunDescription& description) {
    const std::string path = folder_.Path("run.json");
    EXPECT_TRUE(WriteRunDescription(description, path).ok());
    return json::parse(ReadWholeFile(path, 1 << 20).value());
  }

  Result<LoadedRun> Read(const json& document) {
    // A new file each time: some file systems write through what is
    // overwritten.
    std::filesystem::remove(folder_.Path("changed/run.json"));
    const auto description =
        ReadRunDescription(folder_.Write("changed/run.json", document.dump()));
    if (!description.ok()) return description.error();
    LoadedRun run;
    run.description = *description;
    run.read = ReaderOf({});
    return run;
  }

  TempFolder folder_;
};

TEST_F(RunFieldsTest, EveryFieldThatIsWrittenIsDeclaredAndTheOtherWayRound) {
  std::set<std::string_view> met;
  for (const char* backend :
       {"openai", "gemini", "anthropic", "chat", "exchange", "replay"}) {
    const json flat = Written(Described(backend)).flatten();
    for (const auto& [path, value] : flat.items()) {
      if (value.is_null()) continue;  // An empty object or array.
      const RunField* field = FindField(path);
      EXPECT_NE(field, nullptr)
          << path << " is written to run.json: declare in "
          << "benchmark/run_fields.cc what it means for titles and tables";
      if (field != nullptr) met.insert(field->path);
    }
  }
  for (const RunField& field : RunFields()) {
    EXPECT_TRUE(met.contains(field.path)) << field.path << " is never written";
  }
}

TEST_F(RunFieldsTest, WhatATitleSaysHasWordsAndAPaperValue) {
  std::set<std::string_view> words;
  for (const RunField& field : RunFields()) {
    SCOPED_TRACE(field.path);
    const bool of_title = field.role == FieldRole::kVersion ||
                          field.role == FieldRole::kAblation ||
                          field.role == FieldRole::kNoise ||
                          field.role == FieldRole::kBeyond;
    if (of_title) {
      EXPECT_FALSE(field.words.empty());
      EXPECT_FALSE(field.paper.empty());
    }
    if (field.words.empty()) continue;
    EXPECT_TRUE(words.insert(field.words).second);
    // Words without the value can tell but one value from the paper's.
    const bool flag = field.paper == "true" || field.paper == "false";
    EXPECT_EQ(field.words.find("{}") == std::string_view::npos, flag);
  }
}

TEST_F(RunFieldsTest, ThePapersSettingsAreThoseOfARunWithoutOptions) {
  for (const char* provider : {"openai", "gemini", "anthropic"}) {
    LoadedRun run;
    run.description = Described(provider);
    EXPECT_TRUE(StandsForPaper(run, "advisor", provider));
    EXPECT_FALSE(StandsForPaper(run, "direct", provider));
    EXPECT_TRUE(IsPlain(run) && IsOfAblation(run) && IsOfNoise(run));
    EXPECT_THAT(WordsOf(run.description), ::testing::IsEmpty());
    // As do those of a file that has none of them.
    LoadedRun bare = run;
    bare.description.settings_json = "{}";
    EXPECT_TRUE(IsAtPaper(bare.description, FieldRole::kBeyond));
  }
}

TEST_F(RunFieldsTest, AFieldThatNobodyDeclaredStandsInTheTitle) {
  json document = Written(Described("openai"));
  const LoadedRun plain = Read(document).value();
  document["configuration"]["settings"]["model_settings"]["temperature"] = 0.7;
  const LoadedRun warm = Read(document).value();
  EXPECT_THAT(RowTitle(warm), HasSubstr("temperature 0.7"));
  EXPECT_FALSE(warm.description.SameFigures(plain.description));
  EXPECT_FALSE(IsOfAblation(warm));
  EXPECT_FALSE(StandsForPaper(warm, "advisor", "openai"));
  document["configuration"]["weather"] = "rain";
  EXPECT_THAT(ErrorMessage(Read(document)),
              HasSubstr("does not know the field /configuration/weather"));
}

TEST_F(RunFieldsTest, AMissingFieldIsNamedInPlainWords) {
  json document = Written(Described("openai"));
  document["configuration"].erase("stride");
  const std::string message = ErrorMessage(Read(document));
  EXPECT_THAT(message, HasSubstr("stride"));
  EXPECT_THAT(message, HasSubstr("run.json"));
  EXPECT_THAT(message, ::testing::Not(HasSubstr("json.exception")));
}

TEST_F(RunFieldsTest, NoTwoMethodsHaveOneTitle) {
  std::map<std::string, std::string> methods;
  const auto add = [&](const RunDescription& d, const std::string& name) {
    LoadedRun run;
    run.description = d;
    const auto [other, added] = methods.emplace(RowTitle(run), name);
    EXPECT_TRUE(added) << name << " and " << other->second << " are both "
                       << other->first;
  };
  const auto deterministic = [&](const std::string& method,
                                 const std::string& backend) {
    RunDescription last;
    for (const bool gate : {false, true}) {
      const MethodInfo info =
          FindDeterministicMethod(method, backend, gate).value().info;
      RunDescription d;
      d.method = info.method;
      d.backend = info.backend;
      d.title = info.title;
      d.rule = info.rule;
      d.settings_json = "{}";
      d.stride = 50;
      d.joints = "2r";
      // One that falls back by itself is not changed by a gate.
      if (!gate || !d.SameFigures(last)) {
        add(d, method + backend + (gate ? " gated" : ""));
      }
      last = d;
    }
  };
  for (const std::string& name : RefinerNames()) deterministic("advisor", name);
  for (const std::string& name : PlainMethodNames()) deterministic(name, "");
  for (const char* backend :
       {"openai", "gemini", "anthropic", "chat", "exchange", "replay"}) {
    add(Described(backend), backend);
    add(Described(backend, {.polish = true}),
        std::string(backend) + " polished");
  }
}

// The leaves that a person may set, with values that each can have.
class RandomRuns {
 public:
  explicit RandomRuns(json document) : flat_(document.flatten()) {
    for (const auto& [path, value] : flat_.items()) {
      const RunField* field = FindField(path);
      if (field != nullptr && Varies(*field)) paths_.push_back(path);
    }
  }

  json Next() {
    json changed = flat_;
    for (int i = std::uniform_int_distribution(0, 3)(random_); i > 0; --i) {
      const std::string& path =
          paths_[std::uniform_int_distribution<std::size_t>(
              0, paths_.size() - 1)(random_)];
      changed[path] = Other(flat_[path]);
    }
    return changed.unflatten();
  }

 private:
  // Method and counting go together; NoTwoMethodsHaveOneTitle has them.
  static bool Varies(const RunField& field) {
    return field.role != FieldRole::kMethod || !field.words.empty() ||
           field.path.ends_with("/provider") || field.path.ends_with("/model");
  }

  json Other(const json& value) {
    const int n = std::uniform_int_distribution(1, 2)(random_);
    if (value.is_boolean()) return !value.get<bool>();
    if (value.is_number_integer()) return value.get<std::int64_t>() + n;
    if (value.is_number()) return value.get<double>() + 0.5 * n;
    return value.get<std::string>() + (n == 1 ? "-b" : "-c");
  }

  json flat_;
  std::vector<std::string> paths_;
  std::mt19937 random_{11};
};

// What of a run.json of `advisor` decides its figures, worked out anew.
json Essence(json document) {
  json c = document.at("configuration");
  json& s = c.at("settings");
  c.erase("title");
  c.erase("cases");
  c.at("dataset").erase("name");
  c.at("dataset").erase("version");
  if (s.at("route_text") == false) s.erase("stretches");
  if (s.at("rea") == false) s.erase("reference_pool");
  if (s.at("rea") == false && s.at("noise") == 0) s.erase("seed");
  if (s.at("rounds") == 1) s.erase("rounds_deadline_s");
  return {c, document.at("models"), document.at("recorded")};
}

TEST_F(RunFieldsTest, RunsShareATitleOnlyWhenNothingThatMattersDiffers) {
  RunDescription paper = Described("openai");
  const json written = Written(paper);
  RandomRuns random(written);
  int shared = 0;
  for (int i = 0; i < 3'000; ++i) {
    json a = random.Next();
    json b = random.Next();
    // Answers of one model on one day.
    for (const char* fixed : {"models", "recorded", "schema", "shard"}) {
      a[fixed] = b[fixed] = written[fixed];
    }
    a["configuration"]["title"] = b["configuration"]["title"] = "LLM-Advisor";
    const auto first = Read(a);
    const auto second = Read(b);
    ASSERT_TRUE(first.ok()) << ErrorMessage(first);
    ASSERT_TRUE(second.ok()) << ErrorMessage(second);
    const bool alike = Essence(a) == Essence(b);
    EXPECT_EQ(first->description.SameRow(second->description), alike)
        << json::diff(a, b);
    const bool one_table = !FindMismatch(*first, *second).value();
    EXPECT_EQ(RowTitle(*first) == RowTitle(*second) && one_table, alike)
        << json::diff(a, b);
    shared += alike ? 1 : 0;
    if (HasFailure()) return;
  }
  EXPECT_GT(shared, 50);
}

TEST_F(RunFieldsTest, EachDeclaredSettingPutsARunWhereItBelongs) {
  const json document = Written(Described("openai"));
  const json flat = document.flatten();
  for (const RunField& field : RunFields()) {
    if (!flat.contains(std::string(field.path))) continue;
    json changed = flat;
    json& value = changed[std::string(field.path)];
    if (value.is_boolean()) {
      value = !value.get<bool>();
    } else if (value.is_number()) {
      value = value.get<int>() + 2;
    } else {
      value = value.get<std::string>() + "-other";
    }
    if (field.path.ends_with("/rounds_deadline_s")) {
      changed["/configuration/settings/rounds"] = 2;
    }
    const auto run = Read(changed.unflatten());
    if (!run.ok()) continue;  // Another schema, a shard that there is not.
    SCOPED_TRACE(field.path);
    EXPECT_EQ(IsPlain(*run), field.role != FieldRole::kNoise &&
                                 field.role != FieldRole::kAblation);
    const bool beyond = field.role == FieldRole::kBeyond;
    if (beyond || field.role == FieldRole::kNoise) {
      EXPECT_FALSE(IsOfAblation(*run));
    }
    if (beyond || field.role == FieldRole::kAblation) {
      EXPECT_FALSE(IsOfNoise(*run));
    }
    if (beyond) {
      EXPECT_FALSE(StandsForPaper(*run, "advisor", "openai"));
    }
  }
}

}  // namespace
}  // namespace terra::benchmark
