#include "advisor/prompt.h"

#include <array>

#include "advisor/descriptions.h"
#include "terrain/require.h"

namespace terra::advisor {
namespace {

std::string Range(const TerrainMap& map) {
  return "x from 0 to " + std::to_string(map.width() - 1) + ", y from 0 to " +
         std::to_string(map.height() - 1);
}

bool ShowsBaseline(const PromptInput& in) {
  return in.method == Method::kAdvisor && in.switches.overlay;
}
bool DescribesBaseline(const PromptInput& in) {
  return in.method == Method::kAdvisor && in.switches.route_text;
}
bool ShowsReference(const PromptInput& in) {
  return in.method == Method::kAdvisor && in.reference.has_value();
}

std::string TaskText(const PromptInput& in) {
  switch (in.method) {
    case Method::kAdvisor:
      return "You advise a robot's route planner on terrain costs.\n"
             "The planner may only use a coarse, fixed graph of routes. Its "
             "best route on that graph is the baseline. The map is finer than "
             "the graph, so a cheaper route may exist that the planner cannot "
             "represent. Judge whether the baseline is the cheapest way; if "
             "another way could be cheaper, propose it. You may place "
             "waypoints on any cell of the map.\n";
    case Method::kDirect:
      return "You plan the route of a robot over a map of terrain costs. "
             "Give the route from start to goal with the lowest total cost. "
             "You may place waypoints on any cell of the map.\n";
    case Method::kLlmAstar:
      return "You guide the search for a robot's route over a map of terrain "
             "costs. Give the intermediate targets that a cheap route should "
             "pass, in order. An exact search then joins start, targets and "
             "goal, each to the next, at the lowest cost.\n";
  }
  return "";
}

std::string PictureText(const PromptInput& in) {
  std::string text = "PICTURES\n";
  int number = 0;
  const auto image = [&number] {
    return "Image " + std::to_string(++number) + ": ";
  };
  text += image() +
          "the terrain map. The start is the black cell in a ring, marked S; "
          "the goal is the black cell in a square, marked G.\n";
  if (ShowsBaseline(in)) {
    text += image() +
            "the same map with the baseline drawn as a blue line with a white "
            "edge. The edge tells it from terrain that is blue too.\n";
  }
  if (ShowsReference(in)) {
    text += image() +
            "a reference example from another map: the same map and ends "
            "twice, side by side. Left, a route that was verified as cheaper. "
            "Right, a route that can be driven but was rejected because it "
            "costs more. Its scale and coordinates have nothing to do with "
            "your map.\n";
  }
  return text;
}

std::string CoordinateText(const PromptInput& in) {
  return "COORDINATES\n"
         "A cell is (x, y), two integers; (0, 0) is the top left one, x grows "
         "to the right and y downwards. The map has " +
         Range(in.shown) + ".\n" +
         PixelText(in.frame, ShowsBaseline(in) ? "images 1 and 2" : "image 1");
}

std::string CostRuleText(const TerrainMap& map) {
  std::string text =
      "COST\n"
      "Waypoints are joined by straight lines, which are turned into cells of "
      "the map. Every step to a neighbouring cell costs its length (1, or "
      "1.414 diagonally) times the cost of the cell entered; the sum is the "
      "cost of the route. A route that enters an obstacle or leaves the map "
      "is invalid.\n";
  if (!map.cost_model().corner_cutting) {
    text +=
        "A diagonal step also needs both cells beside it free of "
        "obstacles.\n";
  }
  if (map.cost_model().clearance_cells > 0) {
    text += "Cells within " + std::to_string(map.cost_model().clearance_cells) +
            " cells of an obstacle count and are drawn as obstacle.\n";
  }
  return text + "Colours and costs:\n" + LegendText(map.legend());
}

std::string TerrainSection(const PromptInput& in) {
  return "TERRAIN\n"
         "Connected areas of one cost, largest first. The extent is the "
         "smallest box around an area (upper left to lower right cell); an "
         "area need not fill its box.\n" +
         TerrainText(in.shown, in.switches.regions);
}

std::string BaselineSection(const PromptInput& in) {
  std::string text =
      "BASELINE\n"
      "Every fifth cell that the baseline passes, from the first to the last, "
      "with the cost of its terrain:\n" +
      BaselineText(in.clean, in.baseline, in.baseline_cost);
  if (in.switches.stretches) {
    text += "Where the cost of the baseline arises, from start to goal:\n" +
            StretchText(in.clean, in.baseline);
  }
  return text;
}

std::string ReferenceSection(const ReferenceCosts& costs) {
  const double gap = costs.right - costs.left;
  return "REFERENCE EXAMPLE\n"
         "In the reference example the left route costs " +
         TotalText(costs.left) + ", the right one " + TotalText(costs.right) +
         ": " + TotalText(gap) + " more, or " +
         TotalText(100 * gap / costs.left) +
         " percent of the left one's cost. The left route is the longer "
         "one.\n";
}

std::string AdviceRules(const PromptInput& in) {
  const std::string baseline =
      in.switches.overlay ? "the baseline shown" : "the baseline";
  std::string text =
      "HOW TO DECIDE\n"
      "- Take " +
      baseline +
      " as what is to be beaten.\n"
      "- Compare it with the corridors of terrain that the map shows. Look "
      "above all for connected cheap terrain that is a longer way but costs "
      "less in total.\n"
      "- Weigh distance and terrain cost together.\n"
      "- Answer No with one complete route whenever a corridor from start to "
      "goal could plausibly be cheaper. It need not be certain: a program "
      "will check it exactly.\n"
      "- With No, prefer a route that differs clearly from " +
      baseline +
      " over a small local change of it.\n"
      "- With No, the first waypoint is exactly the start and the last one "
      "exactly the goal.\n"
      "- Answer Yes only if " +
      baseline +
      " seems to use the best cheap corridor there is and nothing you see "
      "offers a trade worth having.\n";
  if (ShowsReference(in)) {
    text +=
        "- The reference example only shows that a longer way along a "
        "connected cheap corridor can pay. Do not take over its "
        "coordinates or its shape.\n";
  }
  return text +
         "Your answer is checked on the full map. A route that is invalid, "
         "misses start or goal, or does not cost less than the baseline is "
         "rejected, and the robot keeps the baseline.\n";
}

std::string RouteRules(const PromptInput& in) {
  if (in.method == Method::kDirect) {
    return "HOW TO DECIDE\n"
           "- Weigh distance and terrain cost together: a longer way over "
           "connected cheap terrain can cost less.\n"
           "- The first waypoint is exactly the start and the last one exactly "
           "the goal.\n"
           "- No line between successive waypoints may touch an obstacle.\n";
  }
  return "HOW TO DECIDE\n"
         "- Weigh distance and terrain cost together: a longer way over "
         "connected cheap terrain can cost less.\n"
         "- Give at least one target besides start and goal, each on a cell "
         "that is no obstacle, in the order of travel.\n"
         "- Use few targets: they are passed exactly, so a bad one makes the "
         "route dearer.\n";
}

std::string AnswerInstructions(const PromptInput& in) {
  std::string text = "ANSWER\n";
  const std::string several =
      in.switches.candidates == 1
          ? ""
          : "You may give up to " + std::to_string(in.switches.candidates) +
                " different routes, the best first, separated by semicolons: "
                "[...]; [...]\n";
  if (in.method == Method::kAdvisor) {
    return text +
           "Write one of these two forms and nothing else; all coordinates are "
           "integers.\n"
           "Yes\n"
           "No. [(x1, y1), (x2, y2), ..., (xn, yn)]\n" +
           several;
  }
  return text +
         "Write this form and nothing else; all coordinates are integers.\n"
         "[(x1, y1), (x2, y2), ..., (xn, yn)]\n" +
         several;
}

}  // namespace

std::string_view MethodName(Method method) {
  constexpr std::array<std::string_view, 3> kNames = {"advisor", "direct",
                                                      "llm-astar"};
  return kNames.at(static_cast<std::size_t>(method));
}

std::optional<Method> FindMethod(std::string_view name) {
  for (const Method method :
       {Method::kAdvisor, Method::kDirect, Method::kLlmAstar}) {
    if (MethodName(method) == name) return method;
  }
  return std::nullopt;
}

std::string WritePrompt(const PromptInput& in) {
  TERRA_REQUIRE(in.switches.candidates >= 1);
  std::string text = TaskText(in) + "\n" + PictureText(in) + "\n" +
                     CoordinateText(in) + "Start: " + ToString(in.start) +
                     "\nGoal: " + ToString(in.goal) + "\n\n" +
                     CostRuleText(in.shown) + "\n" + TerrainSection(in) + "\n";
  if (DescribesBaseline(in)) {
    text += BaselineSection(in) + "\n";
  }
  if (ShowsReference(in)) {
    text += ReferenceSection(*in.reference) + "\n";
  }
  text += (in.method == Method::kAdvisor ? AdviceRules(in) : RouteRules(in)) +
          "\n" + AnswerInstructions(in);
  return text;
}

}  // namespace terra::advisor
