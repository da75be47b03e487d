#include "benchmark/missing_rows.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "benchmark/run_labels.h"

namespace terra::benchmark {
namespace {

// A row of the paper that a run here may stand for.
struct PaperRow {
  const char* method;
  const char* backend;
  const char* title;
};

constexpr PaperRow kPaperMethods[] = {
    {"direct", "openai", "Direct LLM (gpt-5.5)"},
    {"direct", "gemini", "Direct LLM (gemini-3.1-pro-preview)"},
    {"direct", "anthropic", "Direct LLM (claude-opus-4-8)"},
    {"llm-astar", "openai", "LLM-A* (gpt-5.5)"},
    {"advisor", "openai", "LLM-Advisor (gpt-5.5)"},
    {"advisor", "gemini", "LLM-Advisor (gemini-3.1-pro-preview)"},
    {"advisor", "anthropic", "LLM-Advisor (claude-opus-4-8)"},
};

std::string KeyVariable(const std::string& backend) {
  if (backend == "openai") return "OPENAI_API_KEY";
  if (backend == "gemini") return "GEMINI_API_KEY";
  return "ANTHROPIC_API_KEY";
}

}  // namespace

std::string HowToMeasure(const std::string& method, const std::string& backend,
                         const std::string& more, const std::string& suffix) {
  return "not measured; " + KeyVariable(backend) +
         "=... terra bench run --dataset DIR --method " + method +
         " --backend " + backend + more + " --out runs/" + method + "-" +
         backend + suffix;
}

bool IsMeasured(const std::vector<LoadedRun>& runs, const std::string& method,
                const std::string& provider,
                const std::vector<std::string>& groups) {
  return std::any_of(runs.begin(), runs.end(), [&](const LoadedRun& run) {
    return StandsForPaper(run, method, provider) &&
           std::any_of(groups.begin(), groups.end(),
                       [&run](const std::string& group) {
                         return MetricsOf(run, group).paths > 0;
                       });
  });
}

void AddMissing(const std::vector<LoadedRun>& runs,
                const std::vector<std::string>& groups, Table& table,
                const std::string& more, const std::string& suffix) {
  std::vector<LoadedRun> plain;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(plain), IsPlain);
  TableBlock missing;
  missing.heading = kMissingHeading;
  for (const PaperRow& row : kPaperMethods) {
    if (IsMeasured(plain, row.method, row.backend, groups)) continue;
    missing.rows.push_back(
        {row.title, HowToMeasure(row.method, row.backend, more, suffix)});
  }
  if (!missing.rows.empty()) table.blocks.push_back(std::move(missing));
}

void NoteWithoutRow(const std::vector<LoadedRun>& runs,
                    const std::function<bool(const LoadedRun&)>& has_row,
                    const std::string& why, Table& table) {
  std::string names;
  for (const LoadedRun& run : runs) {
    if (has_row(run)) continue;
    names += (names.empty() ? "" : "; ") + run.folder + ": " + RowTitle(run);
  }
  if (!names.empty()) {
    table.notes.push_back("Not in this table, which has " + why + ": " + names);
  }
}

}  // namespace terra::benchmark
