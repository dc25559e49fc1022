#pragma once

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/text/format.h"
#include "geometry/triangle_mesh.h"
#include "scene/file_search.h"
#include "scene/mesh_trial.h"
#include "segmentation/lumen/scan.h"
#include "segmentation/lumen_centreline.h"
#include "vessel/centreline/centreline.h"
#include "vessel/centreline/centreline_file.h"
#include "vessel/io/mesh_reader.h"

namespace endovascular_sim::tools
{

/** Files of a vessel under their final names, and under names for the checks of the simulator. */
struct VesselFiles
{
  std::string mesh;
  std::string centreline;
  std::string tried_mesh;
  std::string tried_centreline;

  explicit VesselFiles(const std::string& stem)
    : mesh(stem + ".obj"),
      centreline(stem + "_centreline.yaml"),
      tried_mesh(stem + ".part.obj"),
      tried_centreline(stem + ".part.yaml")
  {
  }
  VesselFiles(const VesselFiles&) = delete;
  VesselFiles& operator=(const VesselFiles&) = delete;
  ~VesselFiles()
  {
    std::error_code code;
    std::filesystem::remove(tried_mesh, code);
    std::filesystem::remove(tried_centreline, code);
  }

  /** Gives the files their final names, in place of those of an earlier vessel. */
  void keep() const
  {
    std::filesystem::rename(tried_mesh, mesh);
    std::filesystem::rename(tried_centreline, centreline);
  }

  /** Message with the final names. */
  std::string named(std::string message) const
  {
    for (const auto& [tried, name] : {std::pair(tried_mesh, mesh), std::pair(tried_centreline, centreline)})
      for (std::size_t at = message.find(tried); at != std::string::npos; at = message.find(tried, at + name.size()))
        message.replace(at, tried.size(), name);
    return message;
  }
};

/** Text as one argument for a shell. */
inline std::string shellArgument(const std::string& text)
{
  const auto isPlain = [](unsigned char c)
  { return c >= 0x80 || std::isalnum(c) != 0 || std::strchr("_-+.,/=:@%", c) != nullptr; };
  if (std::all_of(text.begin(), text.end(), isPlain))
    return text;
  std::string quoted = "'";
  for (const char c : text)
    quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

/** Position [m] as an argument of --set, quoted for a shell. */
inline std::string positionArgument(const Eigen::Vector3d& position)
{
  return formatted("'[%.4f, %.4f, %.4f]'", position.x(), position.y(), position.z());
}

/** Error of a vessel that scenes would refuse.
 *  @param reason that of the simulator
 *  @param remedy what to change */
inline InputError notWritten(const std::string& stem, const std::string& reason, const std::string& remedy)
{
  return InputError(stem + ".obj", "",
                    "is not written, because no scene can use the vessel (" + reason + "); " + remedy);
}

/** Tries the vessel in the bundled scene. @throws InputError with the reason of the simulator */
inline scene::MeshTrial tried(const VesselFiles& files, const std::string& stem, const std::string& remedy)
{
  try
  {
    return scene::tryMesh(std::filesystem::absolute(files.tried_mesh).string(),
                          std::filesystem::absolute(files.tried_centreline).string());
  }
  catch (const InputError& error)
  {
    throw notWritten(stem, files.named(error.what()), remedy);
  }
}

/** Writes mesh and centreline of the grid frame if a scene can use them.
 *  @param stem of the files STEM.obj and STEM_centreline.yaml
 *  @param remedy of a vessel that scenes refuse
 *  @param warnings receives those of the simulator
 *  @return arguments of `simulate` that use the vessel
 *  @throws InputError with the reason of the simulator; an earlier vessel stays */
inline std::string writeVessel(const segmentation::Scan& scan, const geometry::TriangleMesh& mesh,
                               const vessel::CentrelineTree& tree, const std::string& stem, const std::string& remedy,
                               std::vector<std::string>& warnings)
{
  const VesselFiles files(stem);
  vessel::writeObj(segmentation::toPatient(scan, mesh), files.tried_mesh);
  vessel::writeCentreline(segmentation::toPatient(scan, tree), std::filesystem::path(stem).filename().string(),
                          files.tried_centreline);
  const scene::MeshTrial trial = tried(files, stem, remedy);
  for (const std::string& warning : trial.warnings)
    warnings.push_back(files.named(warning));
  files.keep();
  std::string arguments =
      shellArgument(std::filesystem::absolute(scene::configFolder() + "/scenes/mesh.yaml").string()) + " --set " +
      shellArgument("vessel.mesh=" + std::filesystem::absolute(files.mesh).string()) + " --set vessel.unit=1 --set " +
      shellArgument("vessel.centreline=" + std::filesystem::absolute(files.centreline).string());
  if (trial.entry)
    arguments += " --set entry.position=" + positionArgument(*trial.entry);
  return arguments;
}

}  // namespace endovascular_sim::tools
