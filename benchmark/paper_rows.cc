#include "benchmark/paper_rows.h"

#include <array>

#include "terrain/files/csv.h"
#include "terrain/require.h"

namespace terra::benchmark {
namespace {

constexpr std::array<PaperGap, 4> kEasyGaps = {{{10, 78.00, 1.58, 12.73},
                                                {20, 84.00, 3.35, 19.96},
                                                {50, 88.00, 8.73, 35.33},
                                                {100, 92.00, 17.30, 49.16}}};
constexpr std::array<PaperGap, 4> kHardGaps = {{{10, 96.00, 2.53, 12.79},
                                                {20, 100.00, 4.51, 14.41},
                                                {50, 100.00, 11.39, 20.55},
                                                {100, 100.00, 20.75, 29.98}}};

struct PaperTable {
  std::string_view id;
  std::string_view csv;  // Headed by the names of this project's columns.
};

constexpr PaperTable kTables[] = {
    {"comparison-easy",
     R"(Method,N_Lower,N_NonImproving,N_Suggested,FIR %,NDR %,Final validity %,ACR_lower %,FPS
Direct LLM (GPT-5.5),260,680,1000,26.00,26.00,94.00,4.96,0.0588
Direct LLM (Gemini 3.1 Pro),100,900,1000,10.00,10.00,100.00,4.29,0.0858
Direct LLM (Claude Opus 4.8),80,800,1000,8.00,8.00,88.00,4.23,0.2451
LLM-A* (GPT-5.5; native-resolution cost raster),240,740,1000,24.00,24.00,98.00,8.73,0.0896
LLM-Advisor (GPT-5.5) + coarse-lattice A*,520,360,880,52.00,100.00,100.00,14.47,0.0512
LLM-Advisor (Gemini 3.1 Pro) + coarse-lattice A*,80,60,140,8.00,100.00,100.00,21.61,0.1862
LLM-Advisor (Claude Opus 4.8) + coarse-lattice A*,420,380,800,42.00,100.00,100.00,14.28,0.0431
)"},
    {"comparison-hard",
     R"(Method,N_Lower,N_NonImproving,N_Suggested,FIR %,NDR %,Final validity %,ACR_lower %,FPS
Direct LLM (GPT-5.5),80,920,1000,8.00,8.00,100.00,10.06,0.0434
Direct LLM (Gemini 3.1 Pro),60,900,1000,6.00,6.00,96.00,9.59,0.1391
Direct LLM (Claude Opus 4.8),60,840,1000,6.00,6.00,90.00,10.58,0.1967
LLM-A* (GPT-5.5; native-resolution cost raster),360,640,1000,36.00,36.00,100.00,7.69,0.0663
LLM-Advisor (GPT-5.5) + coarse-lattice A*,450,230,680,45.00,100.00,100.00,16.03,0.0468
LLM-Advisor (Gemini 3.1 Pro) + coarse-lattice A*,180,120,300,18.00,100.00,100.00,15.58,0.1259
LLM-Advisor (Claude Opus 4.8) + coarse-lattice A*,380,260,640,38.00,100.00,100.00,13.54,0.0458
)"},
    {"ablation",
     R"(Setting,Subset,N_Suggested,ASR %,FIR %,ACR_lower %,ISR %,VNSR %
full advisor,easy,880,59.09,52.00,14.47,0.00,40.91
without overlay and route text,easy,1000,42.00,42.00,8.98,10.00,48.00
without route text,easy,1000,40.00,40.00,8.81,0.00,60.00
without REA,easy,860,37.21,32.00,11.10,0.00,62.79
full advisor,hard,680,66.18,45.00,16.03,0.00,33.82
without overlay and route text,hard,1000,2.00,2.00,7.04,0.00,98.00
without route text,hard,920,23.91,22.00,7.38,2.17,73.92
without REA,hard,640,31.25,20.00,11.60,0.00,68.75
)"},
    {"rugd",
     R"(Method,Scene,N_Path,N_Suggested,N_Lower,ASR %,FIR %,ACR_lower %,ISR %,VNSR %,NDR %,Final validity %,FPS
Direct LLM (GPT-5.5),creek,745,745,24,3.22,3.22,2.35,20.67,76.11,3.22,79.33,0.0843
Direct LLM (GPT-5.5),park,1638,1638,35,2.14,2.14,2.47,12.39,85.47,2.14,87.61,0.1129
Direct LLM (GPT-5.5),trail,3875,3875,267,6.89,6.89,2.13,3.05,90.06,6.89,96.95,0.0839
Direct LLM (GPT-5.5),village,117,117,6,5.13,5.13,2.27,9.40,85.47,5.13,90.60,0.1279
LLM-A* (GPT-5.5; native-resolution cost raster),creek,745,745,145,19.46,19.46,5.24,2.68,77.86,19.46,97.32,0.1002
LLM-A* (GPT-5.5; native-resolution cost raster),park,1638,1638,550,33.58,33.58,4.98,0.00,66.42,33.58,100.00,0.1123
LLM-A* (GPT-5.5; native-resolution cost raster),trail,3875,3875,897,23.15,23.15,4.87,0.00,76.85,23.15,100.00,0.1003
LLM-A* (GPT-5.5; native-resolution cost raster),village,117,117,35,29.91,29.91,5.18,0.00,70.09,29.91,100.00,0.1350
LLM-Advisor (GPT-5.5) + coarse-lattice A*,creek,745,609,375,61.58,50.34,8.82,0.00,38.42,100.00,100.00,0.0812
LLM-Advisor (GPT-5.5) + coarse-lattice A*,park,1638,1463,650,44.43,39.68,8.09,0.00,55.57,100.00,100.00,0.1030
LLM-Advisor (GPT-5.5) + coarse-lattice A*,trail,3875,3313,1586,47.87,40.93,7.82,0.00,52.13,100.00,100.00,0.0845
LLM-Advisor (GPT-5.5) + coarse-lattice A*,village,117,93,55,59.14,47.01,8.31,0.00,40.86,100.00,100.00,0.1260
)"},
    {"latency",
     R"(Method,Subset,Online LLM calls / case,T_prep s,T_llm s,T_det s,Median T_e2e s,p95 s
coarse-lattice A*,easy,0,0.019,-,0.021,0.041,0.058
Direct LLM (GPT-5.5),easy,1,0.087,17.219,0.002,17.308,23.884
LLM-A* (GPT-5.5; native-resolution cost raster),easy,1,0.089,8.999,0.114,9.210,12.411
LLM-Advisor (GPT-5.5) + coarse-lattice A*,easy,1,0.114,17.373,0.020,17.510,22.188
coarse-lattice A*,hard,0,0.049,-,0.050,0.093,0.127
Direct LLM (GPT-5.5),hard,1,0.185,20.166,0.004,20.348,34.953
LLM-A* (GPT-5.5; native-resolution cost raster),hard,1,0.182,10.351,0.549,11.176,19.852
LLM-Advisor (GPT-5.5) + coarse-lattice A*,hard,1,0.211,14.503,0.039,14.746,17.830
)"},
    {"noise",
     R"(Method,Subset,Noise %,N_Path,N_Suggested,N_Lower,ASR %,ISR %,VNSR %,FIR %,ACR_lower %,NDR %
LLM-Advisor (GPT-5.5) + coarse-lattice A*,easy,0,50,48,21,43.75,0.00,56.25,42.00,15.38,100.00
LLM-Advisor (GPT-5.5) + coarse-lattice A*,easy,5,50,47,24,51.06,0.00,48.94,48.00,15.25,100.00
LLM-Advisor (GPT-5.5) + coarse-lattice A*,easy,10,50,49,21,42.86,0.00,57.14,42.00,16.62,100.00
LLM-Advisor (GPT-5.5) + coarse-lattice A*,hard,0,50,45,21,46.67,2.22,51.11,42.00,13.55,100.00
LLM-Advisor (GPT-5.5) + coarse-lattice A*,hard,5,50,43,16,37.21,0.00,62.79,32.00,14.25,100.00
LLM-Advisor (GPT-5.5) + coarse-lattice A*,hard,10,50,46,13,28.26,0.00,71.74,26.00,12.65,100.00
)"},
};

}  // namespace

PaperGap PaperGapOf(Subset subset, int stride) {
  for (const PaperGap& row : subset == Subset::kEasy ? kEasyGaps : kHardGaps) {
    if (row.stride == stride) return row;
  }
  FailRequirement("a stride of the paper's table", __FILE__, __LINE__);
}

TableBlock PaperBlock(std::string_view table_id,
                      const std::vector<TableColumn>& columns) {
  for (const PaperTable& paper : kTables) {
    if (paper.id != table_id) continue;
    const CsvTable printed = ParseCsv(paper.csv, std::string(paper.id)).value();
    TableBlock block;
    block.heading = kPaperHeading;
    block.published = true;
    for (const CsvRow& row : printed.rows) {
      std::vector<TableCell> cells;
      for (const TableColumn& column : columns) {
        const int place = printed.Column(column.name);
        cells.emplace_back(
            place < 0 ? "-" : row.fields[static_cast<std::size_t>(place)]);
      }
      block.rows.push_back(std::move(cells));
    }
    return block;
  }
  FailRequirement("a table that the paper has", __FILE__, __LINE__);
}

}  // namespace terra::benchmark
