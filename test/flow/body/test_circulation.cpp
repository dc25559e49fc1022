#include "flow/body/circulation.h"

#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::flow
{
namespace
{

class CirculationFile : public testing::Test
{
protected:
  std::string errorOf(const std::string& text)
  {
    std::ofstream(folder_.file("own.yaml")) << text;
    return inputErrorOf([this] { readCirculation(folder_.file("own.yaml")); });
  }

  TemporaryFolder folder_;
};

TEST_F(CirculationFile, OfAnAdultHasTheDefaultsThatItStates)
{
  const Circulation adult = readCirculation(PROJECT_DIR "/config/hemodynamics/adult.yaml");
  const Circulation standard;
  EXPECT_NEAR(adult.heart.rate, standard.heart.rate, 1e-4);
  EXPECT_NEAR(adult.heart.output, standard.heart.output, 1e-8);
  EXPECT_EQ(adult.heart.largest_pressure, standard.heart.largest_pressure);
  EXPECT_EQ(adult.wall.k1, standard.wall.k1);
  EXPECT_EQ(adult.wall.pressure, standard.wall.pressure);
  EXPECT_EQ(adult.mean_pressure, standard.mean_pressure);
  EXPECT_EQ(adult.decay, standard.decay);
  EXPECT_EQ(adult.hyperaemia, standard.hyperaemia);
  EXPECT_EQ(adult.territories.size(), 14U);
}

TEST_F(CirculationFile, IsRefusedWithKeyAndRemedy)
{
  const std::string end = "\noutlets: {territories: [{branch: a, share: 0.5}]}\n";
  EXPECT_NE(errorOf("outlets: {territories: [{branch: a, share: 0.7}, {branch: b, share: 0.6}]}")
                .find("outlets.territories (line 1): their shares add up to 1.3; the sum must be at most 1"),
            std::string::npos);
  EXPECT_NE(errorOf("outlets: {decay: -1.0, territories: []}").find("outlets.decay"), std::string::npos);
  EXPECT_NE(errorOf("heart: {rate: 0}" + end).find("heart.rate"), std::string::npos);
  EXPECT_NE(errorOf("venous_pressure: 2.0e4" + end).find("must be less than mean_pressure"), std::string::npos);
  EXPECT_NE(errorOf("heart: {beats: 70}" + end).find("beats"), std::string::npos);
  EXPECT_NE(inputErrorOf([] { readCirculation("nowhere.yaml"); }).find("nowhere.yaml"), std::string::npos);
}

TEST_F(CirculationFile, IsRefusedForEachNumberThatIsImpossible)
{
  const struct
  {
    const char *map, *key;
    std::vector<const char*> values;
  } rows[] = {{"blood", "density", {"-1060", "0", ".nan", "heavy"}},
              {"blood", "viscosity", {"-0.004", "0"}},
              {"heart", "rate", {"-1", ".inf"}},
              {"heart", "output", {"-8e-5", "0"}},
              {"heart", "largest_stroke", {"-1e-4", "0"}},
              {"heart", "contraction", {"-0.05", "0"}},
              {"heart", "relaxation", {"-0.08", "0"}},
              {"heart", "filling_pressure", {"-1000"}},
              {"heart", "largest_pressure", {"-4e4", "2e4"}},
              {"heart", "backflow", {"-0.02", "0.5"}},
              {"heart", "closure", {"-0.04", "0"}},
              {"wall", "k1", {"-2e6"}},
              {"wall", "k2", {"2253"}},
              {"wall", "k3", {"-8e4", "0"}},
              {"wall", "pressure", {"-1"}},
              {"outlets", "decay", {"-1.3", "0"}},
              {"outlets", "muscle_decay", {"-0.24", "0"}},
              {"outlets", "muscle_proximal", {"-0.5", "0", "1"}},
              {"outlets", "hyperaemia", {"-3.5", "0.5"}},
              {"", "mean_pressure", {"-12400", "0"}},
              {"", "venous_pressure", {"-700"}}};
  for (const auto& row : rows)
    for (const char* value : row.values)
    {
      const std::string map = row.map, pair = std::string(row.key) + ": " + value;
      const std::string text = map.empty() ? pair : map + ": {" + pair + "}";
      const std::string path = map.empty() ? row.key : map + "." + row.key;
      const std::string message = errorOf(map == "outlets" ? text.substr(0, text.size() - 1) + ", territories: []}"
                                                           : text + "\noutlets: {territories: []}");
      EXPECT_NE(message.find("own.yaml: " + path + " (line 1): "), std::string::npos) << text << ": " << message;
      const bool has_remedy =
          message.find("must be") != std::string::npos || message.find("expected a") != std::string::npos;
      EXPECT_TRUE(has_remedy) << text << ": " << message;
    }
}

TEST_F(CirculationFile, IsRefusedForTerritoriesThatContradictEachOther)
{
  const auto message = [this](const std::string& territories)
  { return errorOf("outlets: {territories: [" + territories + "]}"); };
  EXPECT_EQ(message("{branch: a, share: 0.6}, {branch: b, share: 0.4}"), "");
  EXPECT_NE(message("{branch: a, share: 1.2}").find("outlets.territories.0.share (line 1): "), std::string::npos);
  EXPECT_NE(message("{branch: a, share: -0.2}").find("outlets.territories.0.share (line 1): "), std::string::npos);
  EXPECT_NE(message("{branch: a, share: 0.2, muscle: 1.1}").find("outlets.territories.0.muscle (line 1): "),
            std::string::npos);
  EXPECT_NE(message("{share: 0.2}").find("outlets.territories.0.branch"), std::string::npos);
  EXPECT_NE(message("{branch: a, share: 0.1}, {branch: a, share: 0.1}")
                .find("outlets.territories.1.branch (line 1): \"a\" has a share already; keep one of the two"),
            std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::flow
