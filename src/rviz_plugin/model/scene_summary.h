#pragma once

#include <string>
#include <vector>

#include "contrast/injection/injection.h"
#include "endovascular_sim/SessionInfo.h"
#include "instrument/balloon.h"
#include "visualization/instrument_tubes.h"

namespace endovascular_sim::rviz_plugin
{

/** Instrument of a scene, as the panel and the displays need it. */
struct InstrumentSummary
{
  visualization::InstrumentShape shape;  ///< with the name
  double length = 0.0;                   ///< [m]
  double largest_insertion = 0.0;        ///< at which its proximal end stops it, about 1 mm [m]; 0: unknown
  double outside_insertion = 0.0;        ///< at which its tip is out of the introducer [m]
  double force_limit = 0.0;              ///< axial force at which the grip slips or stops [N]
  double torque_limit = 0.0;             ///< torque at which it does [N·m]
  double largest_speed = 0.0;            ///< largest insertion speed [m/s]
  double largest_turning_speed = 0.0;    ///< [rad/s]
  bool has_balloon = false;
  instrument::Balloon balloon;         ///< valid with has_balloon
  bool takes_commands = false;         ///< true: the scene lets a topic drive it
  std::vector<std::string> conflicts;  ///< instruments that cannot be in the introducer together with it
};

/** Step of a scene's procedure, an exchange counted as two. */
struct StepSummary
{
  std::string instrument;  ///< that moves; empty: none
  std::string hint;        ///< advice to a person; empty: none
  std::string goal;        ///< branch that its tip or balloon is to reach; empty: none
};

/** Content of a scene that the displays need. */
struct SceneSummary
{
  std::string name;
  double duration = 0.0;                               ///< [s]
  std::vector<InstrumentSummary> instruments;          ///< from the inside out
  std::vector<StepSummary> steps;                      ///< of the procedure
  std::vector<std::string> pressure_lines;             ///< instruments with a pressure line, where blood flows
  std::vector<std::string> pressure_frames;            ///< frames of their readings
  contrast::Syringe syringe = contrast::kHandSyringe;  ///< of contrast medium
  bool is_guided = false;                              ///< true: a person does these steps

  std::vector<visualization::InstrumentShape> shapes() const;
};

/** Reads the scene of a session.
 *  @throws InputError for a text that is no scene */
SceneSummary sceneSummary(const SessionInfo& info);

}  // namespace endovascular_sim::rviz_plugin
