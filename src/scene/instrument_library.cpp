#include "scene/instrument_library.h"

#include <algorithm>
#include <filesystem>

#include "common/error.h"
#include "common/text/words.h"
#include "scene/file_search.h"
#include "scene/schema/scene_schema.h"
#include "yaml/reader.h"

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
  return "no instrument \"" + name + "\" in the library; " + suggestion(name, libraryNames(), "known: ");
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

/** Merges @p top into @p base; fields of @p top override. */
void overlay(yaml::Node& base, const yaml::Node& top)
{
  for (const auto& [key, value] : top.fields)
  {
    yaml::Node* existing = base.field(key);
    if (existing == nullptr)
      base.fields.emplace_back(key, value);
    else if (existing->kind == yaml::Node::Kind::kMap && value.kind == yaml::Node::Kind::kMap)
      overlay(*existing, value);
    else
      *existing = value;
  }
}

/** Removes `use` or `file` from a map and reads the named file into @p base. @return false if the map has neither */
bool extractBase(yaml::Node& node, const std::string& path, const std::string& scene_file, yaml::Node& base)
{
  if (node.kind != yaml::Node::Kind::kMap)
    return false;
  const yaml::Node* use = node.find("use");
  const yaml::Node* file = node.find("file");
  if (use == nullptr && file == nullptr)
    return false;
  if (use != nullptr && file != nullptr)
    throw InputError(file->file, yaml::keyPath(path, "file") + file->location(),
                     "conflicts with use; keep one of the two");
  const yaml::Node& name = use != nullptr ? *use : *file;
  const std::string key = yaml::keyPath(path, use != nullptr ? "use" : "file");
  if (use != nullptr && (use->kind != yaml::Node::Kind::kScalar || !isInLibrary(use->text)))
    throw InputError(use->file, key + use->location(), unknownName(use->text));
  const std::string found = use != nullptr ? pathInLibrary(use->text).string() : findSceneFile(*file, key, scene_file);
  // An override (--set) has no line number. It names another instrument, so the keys for the previous one are dropped.
  const bool overridden = name.line == 0;
  const auto is_stale = [overridden](const auto& field)
  { return field.first == "use" || field.first == "file" || (overridden && field.second.line != 0); };
  node.fields.erase(std::remove_if(node.fields.begin(), node.fields.end(), is_stale), node.fields.end());
  base = yaml::readTree(found);
  return true;
}

void expandStent(yaml::Node& instrument, const std::string& path, const std::string& scene_file)
{
  yaml::Node* stent = instrument.field("stent");
  yaml::Node file;
  if (stent == nullptr || !extractBase(*stent, path, scene_file, file))
    return;
  const yaml::Node* base = file.find("stent");
  if (base == nullptr || base->kind != yaml::Node::Kind::kMap)
    throw InputError(stent->file, path + stent->location(),
                     "\"" + file.file + "\" is not a stent; give a file with kind: stent");
  yaml::Node merged = *base;
  merged.file = stent->file;
  merged.line = stent->line;
  overlay(merged, *stent);
  *stent = merged;
}

}  // namespace

void expandInstrument(yaml::Node& node, const std::string& path, const std::string& scene_file)
{
  if (node.kind == yaml::Node::Kind::kScalar)
    node = yaml::readTree(findSceneFile(node, path, scene_file));
  yaml::Node base;
  if (extractBase(node, path, scene_file, base))
  {
    overlay(base, node);
    node = base;
  }
  if (node.kind == yaml::Node::Kind::kMap)
    expandStent(node, yaml::keyPath(path, "stent"), scene_file);
}

instrument::Instrument loadInstrument(const std::string& file, const std::vector<std::string>& overrides,
                                      std::vector<std::string>* warnings)
{
  yaml::Node root = yaml::readTree(file);
  expandInstrument(root, "", file);
  for (const std::string& override_text : overrides)
  {
    yaml::overrideTree(root, override_text, file);
    expandInstrument(root, "", file);
  }
  instrument::Instrument instrument;
  yaml::ReadingReport report;
  yaml::Reader reader(root, &report);
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
