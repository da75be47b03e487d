#include "benchmark/dataset_card.h"

#include <string_view>

namespace terra::benchmark {
namespace {

std::string Front(const GenerateOptions& options) {
  return "---\n"
         "pretty_name: " +
         options.name + " " + options.version +
         "\n"
         "license: cc0-1.0\n"
         "tags: [path-planning, terrain, grid-maps, synthetic]\n"
         "---\n\n# " +
         options.name + ", version " + options.version + "\n\n";
}

std::string Summary(const GenerateOptions& options) {
  std::string text =
      "Synthetic terrain-cost maps of 500 x 500 cells with one start and goal "
      "each, drawn after the construction that the MultiTerraPath paper "
      "describes. **These are not the paper's maps**, which are not public: "
      "results on them cannot be compared number by number with published "
      "ones.\n\n";
  for (const Subset subset : options.subsets) {
    text += "- " + std::to_string(options.count) + " cases of subset `" +
            std::string(SubsetName(subset)) + "`, seed " +
            std::to_string(options.seed) + "\n";
  }
  return text + "\n";
}

constexpr std::string_view kContent =
    R"(## Files

| file | content |
|---|---|
| `cases.csv` | `case_id,map,start_x,start_y,goal_x,goal_y,group`; cells, (0,0) top left, x right, y down |
| `maps/*.png` | 8-bit grey PNG, the value of a pixel is a terrain id |
| `legend.csv` | `id,name,cost,color`; cost per cell of travel, `inf` = impassable |
| `dataset.json` | name, version, generator version, seed, parameters, rejection counts, digest |
| `SHA256SUMS` | for `sha256sum -c SHA256SUMS` |

`digest` is the SHA-256 of one line per case: `case_id,map_id,start_x,start_y,goal_x,goal_y`, where map_id is the map's identity in TerraAdvisor (XXH3-64 of its cells, costs and cost model). It does not depend on how the PNG files were compressed.

## How it is made

- Ground of cost 1. Easy: separated polygons, one terrain each. Hard: more and more irregular polygons that overlap, and a winding ribbon. One or two impassable rectangles.
- Start and goal lie in opposite halves (left and right), and a lattice route joins them at strides 10, 20, 50 and 100.
- Case i depends on (seed, subset, i) alone, so the first n cases of a larger set are the smaller one. Integers throughout: the same cells on any machine.
- Sizes are calibrated, on other seeds, to the paper's table of oracle gaps.

## Use and limits

For comparing route refiners under one cost rule. The maps are synthetic: costs, shapes and their layout stand for no real terrain, and nothing follows from them about a robot's safety.

## Licence

CC0 1.0, see LICENSE-DATA in the repository.
)";

}  // namespace

std::string DatasetCard(const GenerateOptions& options) {
  return Front(options) + Summary(options) + std::string(kContent);
}

}  // namespace terra::benchmark
