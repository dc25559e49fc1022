#pragma once

#include <cstddef>
#include <vector>

#include "common/archive.h"
#include "drive/hand_command.h"
#include "scene/model/scene.h"

namespace endovascular_sim::procedure
{

/** Hand of the scripted operator on one instrument. */
struct OperatorHand
{
  double insertion = 0.0, rotation = 0.0;              ///< commanded position [m], [rad]
  double speed = 0.0, turn_speed = 0.0;                ///< present speeds [m/s], [rad/s]
  double target_speed = 0.0, target_turn_speed = 0.0;  ///< target speeds of the acceleration [m/s], [rad/s]
  double pressure = 0.0;                               ///< commanded pressure [Pa]
  bool scripted = false;                               ///< true if the procedure drives the instrument

  void archive(Archive& archive)
  {
    bool was_scripted = scripted;
    archive(was_scripted, insertion, rotation, speed, turn_speed, target_speed, target_turn_speed, pressure);
    if (scripted && !was_scripted)
      throw ArchiveError("was saved while a person drove an instrument, which the scripted operator cannot continue");
  }
};

/** Hands of the scripted operator on all instruments: they reach their target speeds by the accelerations of HandScene.
 */
class OperatorHands
{
public:
  /** Hands at the initial positions of the drives. */
  explicit OperatorHands(const scene::Scene& scene);

  OperatorHand& operator[](int instrument) { return hands_[static_cast<std::size_t>(instrument)]; }

  /** Ends all motions, by the accelerations. */
  void stop();

  /** Commands for one time step, one per instrument. Instruments that the procedure does not drive follow their own
   *  drives.
   *  @param scene that of the constructor
   *  @param end_time time at the end of the step [s] */
  const std::vector<drive::HandCommand>& advance(const scene::Scene& scene, double end_time);

  /** Commands of the last advance(). */
  const std::vector<drive::HandCommand>& commands() const { return commands_; }

  /** Saves or loads the state. */
  void archive(Archive& archive);

private:
  std::vector<OperatorHand> hands_;
  std::vector<drive::HandCommand> commands_;
};

}  // namespace endovascular_sim::procedure
