#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/archive.h"
#include "geometry/triangle_mesh.h"
#include "intervention/balloon_load.h"

namespace endovascular_sim::intervention
{

/** Interface to a wall that yields to balloons and stents. The wall is deformed in this process or by vessel_server. */
class DeformableWall
{
public:
  virtual ~DeformableWall() = default;

  /** Applies the balloon load of a step. Contact detection keeps its current version of the wall until activate().
   *  @param step index of the simulation step
   *  @return version of the deformed wall: the previous version plus one */
  virtual std::uint64_t applyLoad(std::uint64_t step, const BalloonLoad& load) = 0;

  /** Makes contact detection use a version that applyLoad() has returned. */
  virtual void activate(std::uint64_t version) = 0;

  virtual std::uint64_t version() const = 0;  ///< version last returned by applyLoad(), or the initial version

  /** Present mesh of the wall; null if another process keeps it. */
  virtual const geometry::TriangleMesh* mesh() const { return nullptr; }

  /** Vertices of the version that contact detection uses; null if another process keeps it.
   *  @throws InputError when another process does not send it */
  virtual const std::vector<Eigen::Vector3d>* detected() { return nullptr; }

  /** True if the wall has been stretched beyond the critical stretch anywhere, as last reported. */
  virtual bool atRisk() const = 0;

  /** State of the wall and of its contact detection.
   *  @throws InputError when another process keeps the wall and does not respond */
  virtual std::string save() = 0;

  /** Continues from a state of save(). After an exception the wall is undefined until the next load() or reset().
   *  @throws ArchiveError for a state that is damaged or of another vessel
   *  @throws InputError as save() */
  virtual void load(const std::string& state) = 0;

  /** Returns to the initial wall and its version. @throws InputError as save() */
  virtual void reset() = 0;

  /** Saves the state into an archive, or loads it from there. */
  void archive(Archive& archive)
  {
    std::string state = archive.reading() ? std::string() : save();
    archive(state);
    if (archive.reading())
      load(state);
  }
};

}  // namespace endovascular_sim::intervention
