#include "scene/yaml/file_search.h"

#include <cstdlib>
#include <filesystem>

#include "common/error.h"

namespace endovascular_sim::scene
{
namespace fs = std::filesystem;

namespace
{

std::string environment(const char* name)
{
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

std::string configFolder()
{
  const std::string folder = environment("ENDOVASCULAR_CONFIG_DIR");
  return folder.empty() ? ENDOVASCULAR_CONFIG_FOLDER : folder;
}

std::string findSceneFile(const SceneNode& node, const std::string& path, const std::string& scene_file)
{
  if (node.kind != SceneNode::Kind::kScalar || node.text.empty())
    throw InputError(node.file, path + node.location(), "expected the path of a file");
  std::error_code error;
  const fs::path current = fs::current_path(error);
  std::vector<fs::path> folders = {fs::absolute(scene_file, error).parent_path(), configFolder(), current,
                                   environment("ENDOVASCULAR_DATA_DIR")};
  if (node.line == 0)
    folders.insert(folders.begin(), current);
  std::string tried;
  for (const fs::path& folder : folders)
  {
    if (folder.empty())
      continue;
    const fs::path candidate = (folder / node.text).lexically_normal();  // an absolute text replaces the folder
    if (fs::is_regular_file(candidate, error))
      return candidate.string();
    if (tried.find(folder.string() + ",") == std::string::npos)
      tried += folder.string() + ", ";
  }
  throw InputError(node.file, path + node.location(),
                   "no such file \"" + node.text + "\"" +
                       (fs::path(node.text).is_absolute() ? "" : "; sought in " + tried.substr(0, tried.size() - 2)) +
                       "; give the path of an existing file");
}

}  // namespace endovascular_sim::scene
