#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drive/command_file.h"
#include "drive/hand_control.h"
#include "robot/command_faults.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::simulation
{

/** True for an instrument that clients drive: a robot, a haptic device, or a file of commands. */
bool isCommanded(const scene::DrivenInstrument& driven);

/** Index of the instrument with a name.
 *  @param file, where name the origin of the command in errors
 *  @throws InputError when the scene has no such instrument, or no client drives it */
std::size_t commandedInstrument(const scene::Scene& scene, const std::string& name, const std::string& file,
                                const std::string& where);

/** Commands of every step to the instruments of a scene, each from its drive: the control of an instrument that clients
 *  drive (drive::HandControl), the scripted operator, or the profile in the scene. The nodes and `simulate` run this
 *  same code. */
class DrivenHands
{
public:
  /** @param scene must outlive this object */
  explicit DrivenHands(const scene::Scene& scene);

  /** Control of an instrument; null if no client drives it. */
  drive::HandControl* control(std::size_t instrument);
  const drive::HandControl* control(std::size_t instrument) const;

  /** Commands of the coming step, one per instrument.
   *  @param scripted commands of the scripted operator; null without one
   *  @param faults that act on these commands, of which the controls see nothing; null without any */
  const std::vector<drive::HandCommand>& next(const Simulation& simulation,
                                              const std::vector<drive::HandCommand>* scripted = nullptr,
                                              const robot::CommandFaults* faults = nullptr);

  /** Holds all instruments that clients drive where they are. */
  void restAt(const Simulation& simulation);

  /** Takes over the numbers and the last reasons of rejections (HandControl::copyRejections()) of the same scene. */
  void copyRejections(const DrivenHands& other);

  /** Saves or loads all controls. @throws ArchiveError for invalid data */
  void archive(Archive& archive);

private:
  const scene::Scene& scene_;
  std::vector<std::optional<drive::HandControl>> controls_;  ///< one per instrument
  std::vector<drive::HandCommand> next_;
};

/** Commands of a file to the instruments of a scene, each given before the first step that begins at its time or later.
 */
class CommandPlayer
{
public:
  /** @param scene must outlive the player
   *  @param file name of the file, in errors and as the name of the client
   *  @throws InputError for an instrument that the scene has not, or that no client drives */
  CommandPlayer(const scene::Scene& scene, const std::string& file, std::vector<drive::TimedCommand> commands);

  /** Doubts about the file: commands after the end of the run, and pauses after velocities and forces that exceed
   *  drive.limits.time_out, with the motion that is lost in them. One line per instrument and cause.
   *  @param end simulated time of the end [s] */
  std::vector<std::string> warnings(double end) const;

  /** @param end simulated time of the end of the run; infinite: until it is stopped [s]
   *  @throws InputError if no command acts before the end, e.g. for stamps of the calendar */
  void requireCommandsBefore(double end) const;

  /** Gives the commands that are due.
   *  @param time simulated time at the beginning of the coming step [s] */
  void play(double time, DrivenHands& hands);

  /** Leaves out the commands before a time, and gives the later ones (again) [s]. */
  void startFrom(double time);

  /** Refusals so far, each with file and line. */
  const std::vector<std::string>& refusals() const { return refusals_; }

private:
  struct Entry
  {
    drive::TimedCommand command;
    std::size_t instrument = 0;
  };

  std::string pausesOf(std::size_t instrument, double end) const;

  const scene::Scene* scene_;
  std::string file_;
  std::vector<Entry> entries_;
  std::size_t next_ = 0;
  std::vector<std::string> refusals_;
};

}  // namespace endovascular_sim::simulation
