#pragma once

#include <string>
#include <vector>

#include "endovascular_sim/SessionInfo.h"
#include "visualization/instrument_tubes.h"

namespace endovascular_sim::rviz_plugin
{

/** Instrument of a scene, as the panel and the displays need it. */
struct InstrumentSummary
{
  visualization::InstrumentShape shape;  ///< with the name
  double length = 0.0;                   ///< [m]
  double force_limit = 0.0;              ///< axial force at which the grip slips or stops [N]
  double largest_speed = 0.0;            ///< largest insertion speed [m/s]
  double largest_turning_speed = 0.0;    ///< [rad/s]
  bool has_balloon = false;
  double nominal_pressure = 0.0;  ///< of the balloon [Pa]
  double rated_pressure = 0.0;    ///< rated burst pressure of the balloon [Pa]
  bool takes_commands = false;    ///< true: the scene lets a topic drive it
};

/** Content of a scene that the displays need. */
struct SceneSummary
{
  std::string name;
  double duration = 0.0;                       ///< [s]
  std::vector<InstrumentSummary> instruments;  ///< from the inside out

  std::vector<visualization::InstrumentShape> shapes() const;
};

/** Reads the scene of a session.
 *  @throws InputError for a text that is no scene */
SceneSummary sceneSummary(const SessionInfo& info);

}  // namespace endovascular_sim::rviz_plugin
