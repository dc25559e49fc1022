#pragma once

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/text/words.h"
#include "image/volume_file.h"
#include "segmentation/clicks/click_set.h"
#include "segmentation/labels/label_names.h"
#include "segmentation/mesh/label_report.h"
#include "segmentation/mesh/label_vessel.h"
#include "segmentation/mesh/segmented_vessel.h"
#include "tools/import_images.h"
#include "tools/stage_clock.h"
#include "tools/tool_output.h"
#include "tools/vessel_files.h"

namespace endovascular_sim::tools
{

/** Arguments of vessel_segment for a label map. */
struct LabelCommand
{
  std::string map;                       ///< file of the label map
  std::vector<std::string> labels;       ///< numbers, or names of the table
  std::string names;                     ///< file of the table of labels; empty: none
  std::vector<std::string> clicks;       ///< files
  std::string out;                       ///< OUT.obj
  segmentation::LabelSettings settings;  ///< without names and clicks
  int series = 0;                        ///< of a DICOM folder
  double memory = 4.0;                   ///< [GB]
  bool quiet = false;
};

/** Remedy of a vessel that scenes refuse. */
constexpr auto kLabelRemedy =
    "correct the mask in the program that made it, give further labels, or choose the ends by --open and --closed";

/** Volume of the chosen labels, which is removed at the end: it is no image of the patient. */
class LabelVolume
{
public:
  explicit LabelVolume(std::string file) : file_(std::move(file)) {}
  LabelVolume(const LabelVolume&) = delete;
  LabelVolume& operator=(const LabelVolume&) = delete;
  ~LabelVolume()
  {
    std::error_code code;
    std::filesystem::remove(file_, code);
  }

  segmentation::Scan read(const LabelCommand& command, const std::vector<segmentation::ChosenLabel>& labels) const
  {
    std::vector<std::string> choices = {"--memory", std::to_string(command.memory)};
    if (command.series > 0)
      choices.insert(choices.end(), {"--series", std::to_string(command.series)});
    for (const segmentation::ChosenLabel& label : labels)
      choices.insert(choices.end(), {"--label", std::to_string(label.number)});
    importImages(command.map, file_, choices);
    return segmentation::Scan(image::readVolume(file_));
  }

private:
  std::string file_;
};

/** Number of a label by its number or its name. @throws InputError for an unknown name */
inline long numberOf(const std::string& text, const segmentation::LabelNames& names, const std::string& table)
{
  char* end = nullptr;
  const long number = std::strtol(text.c_str(), &end, 10);
  if (!text.empty() && *end == '\0')
    return number;
  std::vector<std::string> known;
  for (const auto& [label, name] : names)
  {
    if (name == text)
      return label;
    known.push_back(name);
  }
  if (known.empty())
    throw InputError("command line", "--label",
                     "requires the number of a label, not '" + text + "'; names require a table, --names");
  throw InputError(table, text, "is no name of a label; " + suggestion(text, known, "its names"));
}

/** Labels of the command with their names. */
inline std::vector<segmentation::ChosenLabel> labelsOf(const LabelCommand& command)
{
  segmentation::LabelNames names;
  if (!command.names.empty())
    names = segmentation::readLabelNames(command.names);
  std::vector<segmentation::ChosenLabel> labels;
  std::set<long> chosen;
  for (const std::string& text : command.labels)
  {
    const long number = numberOf(text, names, command.names);
    if (number == 0)
      throw InputError("command line", "--label", "is 0, the background; give the number of a vessel");
    if (!chosen.insert(number).second)
      continue;
    const auto found = names.find(number);
    labels.push_back({number, found == names.end() ? "label_" + std::to_string(number) : found->second, 0});
  }
  return labels;
}

/** Positions of all clicks [m]. */
inline std::vector<Eigen::Vector3d> clicksOf(const std::vector<std::string>& files)
{
  std::vector<Eigen::Vector3d> clicks;
  if (!files.empty())
    for (const segmentation::BranchClicks& branch : segmentation::readClicks(files).branches)
      for (const segmentation::Click& click : branch.clicks)
        clicks.push_back(click.position);
  return clicks;
}

inline void countVoxels(const segmentation::Scan& scan, std::vector<segmentation::ChosenLabel>& labels)
{
  for (const std::int16_t value : scan.volume().stored)
    if (value > 0)
      ++labels[static_cast<std::size_t>(value) - 1].voxels;
}

/** Makes a vessel of labels and writes its files.
 *  @return exit code
 *  @throws InputError */
inline int segmentLabels(LabelCommand command)
{
  const StageClock clock(command.quiet);
  const std::filesystem::path out(command.out);
  const std::string stem = (out.parent_path() / out.stem()).string();
  if (std::filesystem::path(command.map).extension() == ".vol")
    throw InputError(command.map, "--label", "requires the label map itself: NIfTI, NRRD, MetaImage or a DICOM folder");
  std::vector<segmentation::ChosenLabel> labels = labelsOf(command);
  command.settings.clicks = clicksOf(command.clicks);
  for (const segmentation::ChosenLabel& label : labels)
    command.settings.names.push_back(label.name);
  requireWritable(command.out);
  clock.begin("importing the label map");
  const LabelVolume volume(stem + ".part.vol");
  const segmentation::Scan scan = volume.read(command, labels);
  countVoxels(scan, labels);
  segmentation::LabelVessel vessel;
  try
  {
    vessel = segmentation::labelVessel(scan, command.settings, command.map,
                                       [&clock](const std::string& stage) { clock.begin(stage); });
  }
  catch (const segmentation::UnusableSurface& error)
  {
    throw notWritten(stem, error.what(), kLabelRemedy);
  }
  std::vector<std::string> warnings = vessel.warnings;
  clock.begin("checking the vessel as scenes do");
  const std::string arguments = writeVessel(scan, vessel.mesh, vessel.centreline, stem, kLabelRemedy, warnings);
  writeFile(stem + "_report.json", segmentation::labelJson(scan, vessel, labels, warnings));
  clock.begin("done");
  printWarnings("vessel_segment", warnings);
  std::cout << segmentation::labelText(vessel, labels) << vessel.mesh.triangles.size() << " triangles, genus "
            << vessel.genus << ", open ends: " << vessel.openings.size() << ", at most "
            << std::round(1e6 * vessel.report.result_to_input.largest) * 1e-3 << " mm from the smooth mask\nwrote "
            << command.out << ", " << stem << "_centreline.yaml, " << stem << "_report.json\n"
            << "to use the vessel: rosrun endovascular_sim simulate " << arguments << "\n";
  return 0;
}

}  // namespace endovascular_sim::tools
