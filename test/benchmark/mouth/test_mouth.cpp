#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "benchmark/mouth/mouth_reference.h"
#include "benchmark/mouth/mouth_runs.h"

namespace endovascular_sim::benchmark
{
namespace
{

/** A wire that is straight but for a curved end, in free space. */
MouthProblem curvedEnd(double radius)
{
  rod::Section shaft;
  shaft.length = 0.1;
  shaft.radius = 4e-4;
  shaft.density = 6450.0;
  shaft.bending_stiffness = 1e-4;
  shaft.torsional_stiffness = 1e-4;
  rod::Section end = shaft;
  end.length = 0.01;
  end.rest_curvature.y() = -1.0 / radius;
  MouthProblem problem;
  problem.wire.sections = {shaft, end};
  problem.sheath_clearance = problem.clearance = 1.0;
  return problem;
}

// Beyond the mouth, a part without load has its rest shape. The hand is pulled with the energy per length of the
// straightened part.
TEST(MouthReference, AFreeCurvedEndPullsWithItsStraighteningEnergyPerLength)
{
  MouthReference reference(curvedEnd(0.02));
  for (double insertion = 0.5e-3; insertion < 8e-3; insertion += 0.5e-3)
  {
    const double force = reference.force(insertion);
    if (insertion > 7e-3)  // the guide reaches 5.8 mm beyond the mouth
    {
      EXPECT_NEAR(force, -0.5 * 1e-4 * 50.0 * 50.0, 2e-3) << insertion;
    }
  }
}

void expectTheReference(const MouthMotion& motion)
{
  const MouthCurves curves = runMouth(motion);
  for (const auto* way : {&curves.in, &curves.out})
  {
    const MouthDeviation found = deviationOf(*way, curves.reference);
    EXPECT_LE(found.of_tolerance, 1.0) << "at " << 1e3 * found.at << " mm: " << found.largest << " N";
    EXPECT_LE(found.change, 0.02);
  }
}

TEST(Mouth, ForceOfAJudkinsGuideIsThatOfTheQuasiStaticReference)
{
  MouthMotion motion;
  motion.instrument = "guide_6f_jl4";
  motion.travel = 0.05;
  expectTheReference(motion);
}

// On chords the deviation exceeds the tolerance: the guide acts on curves between the nodes.
TEST(Mouth, ForceOfAJudkinsGuideWithEdgesOf2mmIsThatOfTheQuasiStaticReference)
{
  MouthMotion motion;
  motion.instrument = "guide_6f_jl4";
  motion.nodes = 451;
  motion.travel = 0.025;
  expectTheReference(motion);
}

// Beyond 24 mm the plane equilibrium is unstable: the loop turns out of its plane, and back at 14 mm on the way out.
TEST(Mouth, ForceOfAPigtailIsThatOfTheReferenceWhileItIsPlane)
{
  MouthMotion motion;
  motion.instrument = "catheter_6f_pigtail";
  motion.travel = 0.026;
  motion.reference_step = 0.05e-3;  // the force has a kink where the tip touches the tube
  const MouthCurves curves = runMouth(motion);
  for (const auto* way : {&curves.in, &curves.out})
  {
    EXPECT_LE(deviationOf(*way, curves.reference).of_tolerance, 1.0);
    const std::optional<PlaneLeft> left = planeLeft(*way);
    ASSERT_TRUE(left.has_value());
    EXPECT_LT(std::min(left->from, left->to), 25e-3);
    EXPECT_GT(std::min(left->from, left->to), 13e-3);
  }
}

TEST(Mouth, ForceOfAJWireWithUniformNodesIsThatOfTheQuasiStaticReference)
{
  MouthMotion motion;
  motion.instrument = "guidewire_035_j";
  motion.nodes = 750;
  motion.travel = 0.04;
  expectTheReference(motion);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
