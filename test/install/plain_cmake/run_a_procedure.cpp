#include <cstdio>

#include "common/hash.h"
#include "fluoroscopy/image/png_writer.h"
#include "session/session.h"

using namespace endovascular_sim;

int main(int argc, char** argv)
{
  const auto world = session::World::open("pci", {argv + 1, argv + argc});  // overrides, e.g. duration=5
  session::Session first(world);                                            // driven by the procedure's operator
  first.step(static_cast<int>(first.lastStep() / 2));
  const fluoroscopy::Frame& frame = first.image("LAO 40");
  fluoroscopy::writePng("x_ray.png", frame.pixels, frame.pixels, frame.image);

  session::Session second(world);  // shares vessel, wall and patient
  second.load(first.save());
  second.step(static_cast<int>(second.lastStep()));
  std::printf("%.1f s: tip of the wire in %s\n", second.observe().time(), second.observe().branchName(0).c_str());
  std::printf("trajectory_hash %s\n", Hash64::toHex(second.simulation().trajectoryHash()).c_str());
}
