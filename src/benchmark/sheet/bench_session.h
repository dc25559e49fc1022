#pragma once

#include <string>
#include <vector>

#include "session/session.h"

namespace endovascular_sim::benchmark
{

/** Scene of config/scenes by its name, without changes.
 *  @throws InputError for a scene that is refused */
scene::Scene benchScene(const std::string& name);

/** Run of a bench scene with a specimen in it. */
class BenchSession
{
public:
  /** @param name of the scene in config/scenes
   *  @throws InputError for a scene that is refused */
  BenchSession(const std::string& name, const std::vector<std::string>& overrides);

  /** Steps until a simulated time [s]. */
  void runTo(double time);

  /** True at the end of the scene's duration. */
  bool isOver() const { return session_.isOver(); }

  double time() const { return session_.observe().time(); }
  const scene::Scene& scene() const { return session_.scene(); }
  const session::Observation& observe() const { return session_.observe(); }
  const simulation::Simulation& simulation() { return session_.simulation(); }

private:
  session::Session session_;
};

/** Texts of overrides. @{ */
std::string setting(const std::string& key, double value);
std::string setting(const std::string& key, const Eigen::Vector3d& value);
/** @} */

/** Largest curvature of a tube's axis [1/m], and sum of the angles of its bends [rad]. */
double sharpestCurvature(const vessel::TubeShape& tube);
double totalTurn(const vessel::TubeShape& tube);

/** Radius at which the facets of a tube's mesh lie in the mean [m]. */
double meanRadius(const vessel::TubeShape& tube);

/** Mean of a sequence; 0 without values. */
double meanOf(const std::vector<double>& values);

}  // namespace endovascular_sim::benchmark
