#pragma once

#include <memory>
#include <string>

#include "session/session.h"
#include "session/still_image.h"

namespace endovascular_sim::session
{

/** Fluoroscopy images of a procedure, one at the end of each phase in the phase's view: `fluoroscopy/phase_01.png` and
 *  so on. */
class PhasePictures
{
public:
  /** @param folder folder of the results
   *  @throws InputError if the scene has no fluoroscopy or the folder cannot be created */
  PhasePictures(const World& world, const std::string& folder);

  /** Writes an image if a phase has ended; to be called after each step and once at the end.
   *  @param session session with a procedure, always the same */
  void update(const Session& session);

private:
  void writeImage(const Session& session);

  StillImage image_;
  std::string folder_;
  std::string phase_, view_;  ///< of the latest step
  int images_ = 0;
  bool finished_ = false;
};

}  // namespace endovascular_sim::session
