#include "scene/instrument_library.h"

#include <algorithm>
#include <filesystem>

#include "common/error.h"
#include "scene/schema/scene_schema.h"
#include "scene/yaml/file_search.h"
#include "scene/yaml/yaml_reader.h"

namespace endovascular_sim::scene
{
namespace fs = std::filesystem;

namespace
{

fs::path libraryFolder()
{
  return fs::path(configFolder()) / "instruments";
}

std::string unknownName(const std::string& name)
{
  const std::vector<std::string> names = libraryNames();
  const std::string nearest = nearestWord(name, names);
  if (!nearest.empty())
    return "no instrument \"" + name + "\" in the library; did you mean \"" + nearest + "\"?";
  std::string all;
  for (const std::string& each : names)
    all += (all.empty() ? "" : ", ") + each;
  return "no instrument \"" + name + "\" in the library; known: " + all;
}

fs::path pathInLibrary(const std::string& name)
{
  return libraryFolder() / (name + ".yaml");
}

bool isInLibrary(const std::string& name)
{
  std::error_code error;
  return fs::path(name).filename() == name && fs::is_regular_file(pathInLibrary(name), error);
}

SceneNode* fieldOf(SceneNode& map, const std::string& key)
{
  for (auto& field : map.fields)
    if (field.first == key)
      return &field.second;
  return nullptr;
}

/** Merges @p top into @p base; fields of @p top override. */
void overlay(SceneNode& base, const SceneNode& top)
{
  for (const auto& [key, value] : top.fields)
  {
    SceneNode* existing = fieldOf(base, key);
    if (existing == nullptr)
      base.fields.emplace_back(key, value);
    else if (existing->kind == SceneNode::Kind::kMap && value.kind == SceneNode::Kind::kMap)
      overlay(*existing, value);
    else
      *existing = value;
  }
}

std::string joined(const std::string& path, const std::string& key)
{
  return path.empty() ? key : path + "." + key;
}

/** Removes `use` or `file` from a map and reads the named file into @p base. @return false if the map has neither */
bool extractBase(SceneNode& node, const std::string& path, const std::string& scene_file, SceneNode& base)
{
  if (node.kind != SceneNode::Kind::kMap)
    return false;
  const SceneNode* use = node.find("use");
  const SceneNode* file = node.find("file");
  if (use == nullptr && file == nullptr)
    return false;
  if (use != nullptr && file != nullptr)
    throw InputError(file->file, joined(path, "file") + file->location(), "conflicts with use; keep one of the two");
  const SceneNode& name = use != nullptr ? *use : *file;
  const std::string key = joined(path, use != nullptr ? "use" : "file");
  if (use != nullptr && (use->kind != SceneNode::Kind::kScalar || !isInLibrary(use->text)))
    throw InputError(use->file, key + use->location(), unknownName(use->text));
  const std::string found = use != nullptr ? pathInLibrary(use->text).string() : findSceneFile(*file, key, scene_file);
  // An override (--set) has no line number. It names another instrument, so the keys for the previous one are dropped.
  const bool overridden = name.line == 0;
  const auto is_stale = [overridden](const auto& field)
  { return field.first == "use" || field.first == "file" || (overridden && field.second.line != 0); };
  node.fields.erase(std::remove_if(node.fields.begin(), node.fields.end(), is_stale), node.fields.end());
  base = readSceneTree(found);
  return true;
}

void expandStent(SceneNode& instrument, const std::string& path, const std::string& scene_file)
{
  SceneNode* stent = fieldOf(instrument, "stent");
  SceneNode file;
  if (stent == nullptr || !extractBase(*stent, path, scene_file, file))
    return;
  const SceneNode* base = file.find("stent");
  if (base == nullptr || base->kind != SceneNode::Kind::kMap)
    throw InputError(stent->file, path + stent->location(),
                     "\"" + file.file + "\" is not a stent; give a file with kind: stent");
  SceneNode merged = *base;
  merged.file = stent->file;
  merged.line = stent->line;
  overlay(merged, *stent);
  *stent = merged;
}

}  // namespace

void expandInstrument(SceneNode& node, const std::string& path, const std::string& scene_file)
{
  if (node.kind == SceneNode::Kind::kScalar)
    node = readSceneTree(findSceneFile(node, path, scene_file));
  SceneNode base;
  if (extractBase(node, path, scene_file, base))
  {
    overlay(base, node);
    node = base;
  }
  if (node.kind == SceneNode::Kind::kMap)
    expandStent(node, joined(path, "stent"), scene_file);
}

instrument::Instrument loadInstrument(const std::string& file, const std::vector<std::string>& overrides,
                                      std::vector<std::string>* warnings)
{
  SceneNode root = readSceneTree(file);
  expandInstrument(root, "", file);
  for (const std::string& override_text : overrides)
  {
    overrideSceneTree(root, override_text, file);
    expandInstrument(root, "", file);
  }
  instrument::Instrument instrument;
  ReadingReport report;
  SceneReader reader(&root, root, "", &report);
  visitInstrument(reader, instrument);
  reader.finish();
  if (warnings != nullptr)
    *warnings = report.warnings;
  return instrument;
}

std::vector<std::string> libraryNames()
{
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(libraryFolder(), error))
    if (entry.path().extension() == ".yaml")
      names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string libraryInstrument(const std::string& name)
{
  if (!isInLibrary(name))
    throw InputError(libraryFolder().string(), "", unknownName(name));
  return pathInLibrary(name).string();
}

}  // namespace endovascular_sim::scene
