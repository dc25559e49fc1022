#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/error.h"
#include "scene/scene_file.h"
#include "test/common/random_damage.h"
#include "test/common/temporary_folder.h"

// Damaged scene files: the parser returns a scene that holds the file's numbers, or throws InputError.

namespace endovascular_sim::scene
{
namespace
{

constexpr int kMutations = 2000;  // of each kind, over all scenes

/** Scene files of the package; relative paths in them are searched beside them. */
std::vector<std::string> sceneFiles()
{
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(PROJECT_DIR "/config/scenes"))
    if (entry.path().extension() == ".yaml")
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

const std::vector<std::string> kYamlTexts = {"\n",    "  ",   ": ",        "- ",   "[",
                                             "]",     "{",    "}",         "&a ",  "*a",
                                             "#",     "'",    "\"",        "<<: ", "!!int ",
                                             "1e308", "nan",  "\t",        "|",    ">",
                                             "---\n", "\xff", "%YAML 9\n", "? ",   std::string(1, '\0')};

const std::string kDriveLimits[] = {"insertion", "rotation", "speed", "turning_speed", "force", "torque", "pressure"};

/** True if a resolved scene is read again as the same scene and contains no NaN; texts, in quotes, may begin with one.
 */
void expectConsistent(const Scene& scene, const std::string& origin)
{
  for (const char* number : {" nan", "[nan"})
    EXPECT_EQ(scene.resolved_yaml.find(number), std::string::npos) << scene.resolved_yaml;
  EXPECT_EQ(parseScene(scene.resolved_yaml, origin).hash(), scene.hash()) << scene.resolved_yaml;
}

TEST(DamagedScene, IsReadConsistentlyOrRejected)
{
  const std::vector<std::string> files = sceneFiles();
  ASSERT_FALSE(files.empty());
  test::RandomDamage damage(1, kYamlTexts);
  int accepted = 0;
  for (int k = 0; k < kMutations; ++k)
  {
    const std::string& file = files[static_cast<std::size_t>(k) % files.size()];
    const std::string damaged = damage.of(contentOf(file));
    try
    {
      const Scene scene = parseScene(damaged, file);
      ++accepted;
      expectConsistent(scene, file);
    }
    catch (const InputError& error)
    {
      EXPECT_NE(std::string(error.what()).find("/config/"), std::string::npos) << error.what();
    }
  }
  EXPECT_LT(accepted, kMutations);
}

TEST(DamagedScene, HoldsEveryChangedNumberOrIsRejected)
{
  static const std::string kNumbers[] = {"-1",         "0",
                                         "1e308",      "-1e308",
                                         "1e-308",     ".inf",
                                         "-.inf",      ".nan",
                                         "1e999",      "1e-999",
                                         "0x10",       "1_000",
                                         "1,5",        "12 mm",
                                         "''",         "~",
                                         "1e",         "--1",
                                         "1.5",        "3",
                                         "2147483648", "18446744073709551616"};
  const std::vector<std::string> files = sceneFiles();
  const std::regex number("(: |- |\\[|, )([-+]?[0-9.][0-9.e+-]*)");
  std::mt19937 random(2);
  for (int k = 0; k < kMutations; ++k)
  {
    const std::string& file = files[static_cast<std::size_t>(k) % files.size()];
    static std::vector<std::string> resolved(files.size());
    std::string& text = resolved[static_cast<std::size_t>(k) % files.size()];
    if (text.empty())
      try
      {
        text = parseScene(contentOf(file), file).resolved_yaml;
      }
      catch (const InputError&)
      {
        continue;  // the scene's mesh is not on this machine
      }
    std::vector<std::smatch> numbers;
    for (auto match = std::sregex_iterator(text.begin(), text.end(), number); match != std::sregex_iterator(); ++match)
      numbers.push_back(*match);
    const std::smatch& changed = numbers[random() % numbers.size()];
    const std::string& value = kNumbers[random() % std::size(kNumbers)];
    const std::string damaged = text.substr(0, static_cast<std::size_t>(changed.position(2))) + value +
                                text.substr(static_cast<std::size_t>(changed.position(2) + changed.length(2)));
    try
    {
      const Scene scene = parseScene(damaged, file);
      expectConsistent(scene, file);
      // An accepted number is in the scene: it is neither clamped, nor rounded, nor ignored. Directions are normalised.
      const std::size_t line = text.rfind('\n', static_cast<std::size_t>(changed.position())) + 1;
      const std::string key = text.substr(line, text.find(':', line) - line);
      // The URDF of a robot narrows the limits of its instruments, also those of a resolved scene.
      const std::string name = key.substr(key.find_first_not_of(" -"));
      const bool is_direction =
          (name == "direction" || name == "up" || name == "axis") && text.compare(line + key.size(), 3, ": [") == 0;
      const bool is_narrowed = text.find("\nrobot:") != std::string::npos &&
                               std::count(std::begin(kDriveLimits), std::end(kDriveLimits), name) > 0;
      double number_read = 0.0;
      const bool is_other = std::sscanf(value.c_str(), "%lf", &number_read) == 1 &&
                            number_read != std::stod(changed.str(2)) && !is_direction;
      if (is_other && !is_narrowed)
      {
        EXPECT_NE(scene.hash(), parseScene(text, file).hash()) << key << changed.str() << " replaced by " << value;
      }
    }
    catch (const InputError& error)
    {
      EXPECT_NE(std::string(error.what()).find("/config/"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace endovascular_sim::scene
