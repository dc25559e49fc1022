#pragma once

#include <cstdint>

#include "intervention/vessel_opening.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::intervention
{

/** What moves the wall of a vessel: in this process, or vessel_server behind its topics. */
class DeformableWall
{
public:
  virtual ~DeformableWall() = default;

  /** Lets a step's balloon act on the wall. What contact searches does not change yet.
   *  @param step of the simulation
   *  @return the version of the vessel that comes of it, one more than before */
  virtual std::uint64_t press(std::uint64_t step, const BalloonLoad& pressing) = 0;

  /** From now on contact searches this version, which press() has promised. */
  virtual void show(std::uint64_t version) = 0;

  virtual std::uint64_t version() const = 0;  ///< last promised, or that of the vessel at the beginning

  /** Whether some wall was stretched so far that it may tear, as far as is known. */
  virtual bool atRisk() const = 0;

  /** Saves or loads all that changes, what contact searches included; loading needs the wall of the beginning.
   *  @throws std::logic_error where the wall is another process's */
  virtual void archive(Archive& archive) = 0;
};

}  // namespace endovascular_sim::intervention
