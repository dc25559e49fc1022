#pragma once

#include <string>
#include <vector>

#include "instrument/instrument.h"
#include "yaml/tree.h"

namespace endovascular_sim::scene
{

/** Expands the reference to an instrument file in a scene:
 *
 *      instrument: instruments/my_wire.yaml            # file, searched like any path of a scene
 *      instrument: {file: my_wire.yaml, tip: {…}}      # file with overriding keys
 *      instrument: {use: guidewire_035_j, name: wire}  # config/instruments/guidewire_035_j.yaml
 *
 *  Maps are merged key by key; other values are replaced. The key `stent` of a balloon catheter may refer to a stent's
 *  file in the same way. If an override names another instrument, all keys for the previous one are dropped.
 *  @param node one instrument of a scene
 *  @param path key path of the instrument
 *  @param scene_file scene file, whose folder is searched first
 *  @throws InputError for a missing file, for an unknown name (suggesting the nearest one), or if both `use` and `file`
 *          are given */
void expandInstrument(yaml::Node& node, const std::string& path, const std::string& scene_file);

/** Loads one instrument.
 *  @param file path of the YAML file
 *  @param overrides texts `key.path=value`, applied in order before validation
 *  @param warnings receives the unusual values, as Scene::warnings; may be null
 *  @throws InputError with file, key and remedy */
instrument::Instrument loadInstrument(const std::string& file, const std::vector<std::string>& overrides = {},
                                      std::vector<std::string>* warnings = nullptr);

/** Names of all instruments in the library, sorted. */
std::vector<std::string> libraryNames();

/** Path of the library instrument with this name.
 *  @throws InputError for an unknown name, suggesting the nearest one */
std::string libraryInstrument(const std::string& name);

}  // namespace endovascular_sim::scene
