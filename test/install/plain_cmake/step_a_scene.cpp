#include <cstdio>

#include "common/hash.h"
#include "session/session.h"

int main(int argc, char** argv)
{
  endovascular_sim::session::Session session(argc > 1 ? argv[1] : "tube");
  while (session.step(1000) > 0)  // or session.step(commands), one command per instrument
  {
    const auto& seen = session.observe();
    const Eigen::Vector3d tip = seen.tip(0).position;
    std::printf("%.1f s: tip %.4f %.4f %.4f m, force on the hand %.3f N\n", seen.time(), tip.x(), tip.y(), tip.z(),
                seen.hand(0).force);
  }
  std::printf("trajectory_hash %s\n", endovascular_sim::Hash64::toHex(session.simulation().trajectoryHash()).c_str());
}
