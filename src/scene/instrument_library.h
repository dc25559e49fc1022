#pragma once

#include <string>
#include <vector>

#include "instrument/instrument.h"
#include "scene/yaml/yaml_tree.h"

namespace endovascular_sim::scene
{

/** Replaces what names an instrument of the library by the content of its file:
 *
 *      instrument: instruments/my_wire.yaml            # a file, sought like every path of a scene
 *      instrument: {file: my_wire.yaml, tip: {…}}      # the same with keys of one's own on top
 *      instrument: {use: guidewire_035_j, name: wire}  # config/instruments/guidewire_035_j.yaml
 *
 *  Maps are merged key by key, everything else is replaced. In the same way a balloon catheter's `stent` may be
 *  `{use: …}` or `{file: …}` of a stent's file. Where an override names another instrument, what the scene's file says
 *  about the one before is dropped.
 *  @param node one instrument of a scene
 *  @param path its key path
 *  @param scene_file beside which files are sought
 *  @throws InputError for a missing file or name (with the nearest one), or when both `use` and `file` are given */
void expandInstrument(SceneNode& node, const std::string& path, const std::string& scene_file);

/** Reads one instrument.
 *  @param file path of its YAML file
 *  @param overrides `key.path=value` texts, applied in order before checking
 *  @throws InputError naming file, key and remedy */
instrument::Instrument loadInstrument(const std::string& file, const std::vector<std::string>& overrides = {});

/** Names of all instruments in the library, sorted. */
std::vector<std::string> libraryNames();

/** Path of the library's instrument of this name.
 *  @throws InputError naming the nearest one when there is none */
std::string libraryInstrument(const std::string& name);

}  // namespace endovascular_sim::scene
