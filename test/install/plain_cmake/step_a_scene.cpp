#include <cstdio>

#include "common/hash.h"
#include "simulation/offline_session.h"

int main(int argc, char** argv)
{
  endovascular_sim::simulation::OfflineSession session(argc > 1 ? argv[1] : "tube");
  const auto& simulation = session.simulation();
  while (!session.isOver())
  {
    session.step();  // or session.simulation().stepAll(commands), one command per instrument
    const Eigen::Vector3d& tip = simulation.state().position.back();
    if (simulation.steps() % 1000 == 0)
      std::printf("%.1f s: tip %.4f %.4f %.4f m, force on the hand %.3f N\n", simulation.time(), tip.x(), tip.y(),
                  tip.z(), simulation.hand(0).force);
  }
  std::printf("trajectory_hash %s\n", endovascular_sim::Hash64::toHex(simulation.trajectoryHash()).c_str());
}
