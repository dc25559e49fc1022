#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "nodes/player/recorded_texts.h"
#include "nodes/session/bag_survey.h"
#include "nodes/session/session_files.h"
#include "tools/command_line.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file

constexpr int kUseless = 1;  ///< exit code: a bag is of no use
constexpr int kPartly = 3;   ///< exit code: a bag is of use in part

struct Options
{
  std::vector<std::string> bags;
  std::string repaired;
  bool json = false;
  bool quick = false;
  bool scene = false;
  bool urdf = false;
};

int codeOf(const nodes::BagSurvey& survey)
{
  if (!survey.isUsable())
    return kUseless;
  return survey.isComplete() ? 0 : kPartly;
}

/** Worse one of two exit codes. */
int worse(int a, int b)
{
  return a == kUseless || b == kUseless ? kUseless : std::max(a, b);
}

/** Prints the text of the scene, or of the robot's URDF; nothing for a bag without it. */
int printText(const Options& options)
{
  const nodes::RecordedTexts texts = nodes::recordedTexts(nodes::bagsOf(options.bags).front());
  std::cout << (options.scene ? texts.scene : texts.urdf);
  return 0;
}

int check(const Options& options)
{
  if (options.scene || options.urdf)
    return printText(options);
  int code = 0;
  nlohmann::ordered_json surveys = nlohmann::ordered_json::array();
  for (const std::string& bag : nodes::bagsOf(options.bags))
  {
    const nodes::BagSurvey survey = nodes::surveyBag(bag, !options.quick);
    code = worse(code, codeOf(survey));
    if (options.json)
      surveys.push_back(nodes::toJson(survey));
    else
      std::cout << nodes::textOf(survey);
  }
  if (options.json)
    std::cout << surveys.dump(2) << "\n";
  if (options.repaired.empty())
    return code;
  const std::uint64_t messages = nodes::repairBag(options.bags.front(), options.repaired);
  std::cerr << "bag_check: " << messages << " messages in " << options.repaired << "\n";
  return code;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(
      "bag_check",
      "Examines bags of sessions: version, steps, gaps, damages, and what can be done with each: show it, make its "
      "reports, compute it again, and up to which step.",
      "Exit code: 0 every bag is complete; 3 a bag is of use in part; 1 a bag is of no use; 2 wrong arguments.");
  line.argument("BAG", options.bags, "bags of the session node, or folders with their results; an index is not needed");
  line.flag("--json", options.json, "prints a list of objects instead, with all topics and their types");
  line.flag("--quick", options.quick, "does not make the scene and the vessel of a bag, as a replay would");
  line.option("--repair", options.repaired, "FILE",
              "writes the readable messages of a single bag into a new file, with an index");
  line.flag("--scene", options.scene, "prints the scene of the first bag instead; nothing if the bag holds none");
  line.flag("--urdf", options.urdf, "prints the URDF of the first bag's robot instead; nothing if it holds none");
  line.require(
      [&options]() -> std::string
      {
        if (options.scene && options.urdf)
          return "--scene and --urdf exclude each other";
        if (options.repaired.empty())
          return "";
        if (options.bags.size() != 1)
          return "--repair takes a single bag";
        return std::filesystem::exists(options.repaired) ? "--repair: " + options.repaired + " exists already" : "";
      });
  return line.run(argc, argv, [&] { return check(options); });
}
