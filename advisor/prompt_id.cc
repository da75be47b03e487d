#include "advisor/fingerprint.h"
#include "advisor/prompt.h"
#include "terrain/builtin_legends.h"

namespace terra::advisor {

const std::string& PromptId() {
  // All forms of the text for one fixed case: any changed sentence shows.
  static const std::string id = [] {
    ByteRaster ids = ByteRaster::Zero(3, 3);
    ids(1, 1) = 11;
    const TerrainMap map =
        TerrainMap::Create(ids, MultiTerraPathLegend(), {false, 1}).value();
    const Route route = {{0, 0}, {2, 2}};
    Fingerprint hash;
    for (const Method method :
         {Method::kAdvisor, Method::kDirect, Method::kLlmAstar}) {
      for (int bits = 0; bits < 128; ++bits) {
        const auto on = [bits](int bit) {
          return (bits >> bit & 1) != 0;
        };
        PromptInput in{
            .method = method,
            .switches = {.overlay = on(0),
                         .route_text = on(1),
                         .rea = on(2),
                         .axes = on(3),
                         .regions = on(4),
                         .stretches = on(5),
                         .candidates = on(6) ? 3 : 1},
            .shown = map,
            .start = {0, 0},
            .goal = {2, 2},
            .clean = map,
            .baseline = route,
            .baseline_cost = 2,
            .frame = {on(3) ? 2 : 1, 1, on(3) ? 1 : 0, 0, on(3) ? 5 : 0},
            .reference = std::nullopt};
        if (on(2)) in.reference = ReferenceCosts{1, 2};
        hash.Add(WritePrompt(in));
        in.frame = {1, 2, 0, 0, 0};
        hash.Add(WritePrompt(in));
      }
    }
    return hash.Hex().substr(0, 12);
  }();
  return id;
}

}  // namespace terra::advisor
