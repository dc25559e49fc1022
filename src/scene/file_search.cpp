#include "scene/file_search.h"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

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

/** Path of the program, or of the shared library, that this function is linked into. */
fs::path ownFile()
{
  Dl_info info{};
  link_map* object = nullptr;
  const bool found =
      dladdr1(reinterpret_cast<const void*>(&ownFile), &info, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0;
  // The dynamic linker names every object except the program itself.
  const bool in_library = found && object != nullptr && object->l_name != nullptr && object->l_name[0] != '\0';
  std::error_code error;
  return fs::canonical(in_library ? object->l_name : "/proc/self/exe", error);
}

/** share/endovascular_sim/config in the nearest folder above @p file that has it, otherwise in the first one. */
fs::path configAbove(const fs::path& file)
{
  const fs::path config = fs::path("share") / "endovascular_sim" / "config";
  std::error_code error;
  for (fs::path folder = file.parent_path(); folder.has_relative_path(); folder = folder.parent_path())
    if (fs::is_directory(folder / config, error))
      return folder / config;
  return file.parent_path() / config;
}

/** Path with the home folder in place of a leading `~`, as shells replace it at the begin of a word. */
std::string withHome(const std::string& path)
{
  const std::string home = environment("HOME");
  return path.substr(0, 2) == "~/" && !home.empty() ? home + path.substr(1) : path;
}

}  // namespace

std::string configFolder()
{
  const std::string folder = environment("ENDOVASCULAR_CONFIG_DIR");
  return folder.empty() ? configAbove(ownFile()).string() : folder;
}

std::string findSceneFile(const yaml::Node& node, const std::string& path, const std::string& scene_file)
{
  if (node.kind != yaml::Node::Kind::kScalar || node.text.empty())
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
    const fs::path candidate =
        (folder / withHome(node.text)).lexically_normal();  // an absolute text replaces the folder
    if (fs::is_regular_file(candidate, error))
      return candidate.string();
    if (tried.find(folder.string() + ",") == std::string::npos)
      tried += folder.string() + ", ";
  }
  throw InputError(
      node.file, path + node.location(),
      "no such file \"" + node.text + "\"" +
          (fs::path(withHome(node.text)).is_absolute() ? "" : "; searched in " + tried.substr(0, tried.size() - 2)) +
          "; give the path of an existing file");
}

namespace
{

/** File of a package's folder by its word, or else by its path.
 *  @param kind of file, e.g. "anatomy" */
std::string findNamed(const yaml::Node& node, const std::string& path, const std::string& scene_file,
                      const char* folder_name, const std::string& kind)
{
  const bool is_word = node.kind == yaml::Node::Kind::kScalar && !node.text.empty() &&
                       node.text.find_first_of("./\\") == std::string::npos;
  if (!is_word)
    return findSceneFile(node, path, scene_file);
  const fs::path folder = fs::path(configFolder()) / folder_name;
  std::error_code error;
  if (const fs::path file = folder / (node.text + ".yaml"); fs::is_regular_file(file, error))
    return file.string();
  std::vector<std::string> known;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    known.push_back(entry.path().stem().string());
  std::sort(known.begin(), known.end());
  std::string names;
  for (const std::string& name : known)
    names += (names.empty() ? "" : ", ") + name;
  throw InputError(node.file, path + node.location(),
                   "no " + kind + " \"" + node.text + "\"; known: " + names + "; or give the path of a file of one");
}

}  // namespace

std::string findAnatomy(const yaml::Node& node, const std::string& path, const std::string& scene_file)
{
  return findNamed(node, path, scene_file, "anatomies", "anatomy");
}

std::string findCirculation(const yaml::Node& node, const std::string& path, const std::string& scene_file)
{
  return findNamed(node, path, scene_file, "hemodynamics", "circulation");
}

std::string findMotion(const yaml::Node& node, const std::string& path, const std::string& scene_file)
{
  return findNamed(node, path, scene_file, "motion", "motion");
}

}  // namespace endovascular_sim::scene
