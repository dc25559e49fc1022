#include <cstddef>
#include <vector>

#include "patient/body/anatomy_parts.h"

namespace endovascular_sim::patient
{
namespace
{

/** Rotation whose first column points along @p axis. */
Eigen::Matrix3f axesAlong(const Point& axis)
{
  Eigen::Matrix3f axes;
  axes.col(0) = axis.normalized();
  axes.col(1) = Point::UnitZ().cross(axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

/** Ventricle or atrium: outline of its muscle, and within it the cavity. */
struct Chamber
{
  Tissue tissue;
  Point centre;
  Point semi_axes;
  Eigen::Matrix3f axes;
  float wall;  ///< thickness of the muscle [mm]

  SolidPointer outline() const { return ellipsoid(centre, semi_axes, axes); }
  SolidPointer cavity() const { return ellipsoid(centre, semi_axes - Point::Constant(wall), axes); }
};

std::vector<Chamber> chambersOfHeart()
{
  const Eigen::Matrix3f upright = Eigen::Matrix3f::Identity();
  return {{Tissue::kLeftVentricle, Point(38, -42, 146), Point(66, 44, 44), axesAlong(Point(0.70F, -0.50F, -0.50F)), 12},
          {Tissue::kRightVentricle, Point(16, -58, 140), Point(58, 32, 40), axesAlong(Point(0.80F, -0.20F, -0.55F)), 5},
          {Tissue::kRightAtrium, Point(-22, -26, 152), Point(29, 32, 42), upright, 4},
          {Tissue::kLeftAtrium, Point(8, 12, 180), Point(42, 23, 28), upright, 4}};
}

/** Cavities with contrast medium; myocardium divides them. */
void addCavities(BodyPlan& plan, const std::vector<Chamber>& chambers)
{
  for (std::size_t k = 0; k < chambers.size(); ++k)
  {
    BodyPart cavity{replacing(chambers[k].tissue), {chambers[k].cavity()}, {}};
    for (std::size_t other = 0; other < k; ++other)
      cavity.holes.push_back(chambers[other].outline());
    plan.push_back(cavity);
  }
}

}  // namespace

void addHeart(BodyPlan& plan)
{
  const std::vector<Chamber> chambers = chambersOfHeart();
  BodyPart muscle{replacing(Tissue::kMyocardium, 2.0F), {}, {}};
  for (const Chamber& chamber : chambers)
    muscle.solids.push_back(chamber.outline());
  plan.push_back(muscle);
  addCavities(plan, chambers);

  BodyPart vessels{replacing(Tissue::kBlood, 1.5F), {}, {}};
  addChain(vessels.solids, {{Point(14, -44, 182), 16.0F},
                            {Point(24, -28, 212), 14.5F},
                            {Point(24, -8, 232), 12.5F},
                            {Point(38, 14, 240), 10.0F}});
  addChain(vessels.solids, {{Point(22, -8, 230), 11.0F}, {Point(-22, 8, 236), 10.0F}, {Point(-42, 14, 234), 8.0F}});
  addChain(vessels.solids, {{Point(-26, -14, 350), 8.0F},
                            {Point(-29, -8, 300), 9.5F},
                            {Point(-27, -16, 190), 10.5F}});                                // superior vena cava
  addChain(vessels.solids, {{Point(-26, -10, 160), 12.0F}, {Point(-24, 10, 110), 11.5F}});  // inferior vena cava
  addChain(vessels.solids, {{Point(26, -14, 350), 7.0F}, {Point(0, -26, 322), 7.0F}, {Point(-27, -14, 306), 8.0F}});
  plan.push_back(vessels);

  BodyPart trunk{replacing(Tissue::kPulmonaryTrunk), {}, {}};
  addChain(trunk.solids,
           {{Point(16.5F, -40, 189.5F), 12.0F}, {Point(24, -28, 212), 11.0F}, {Point(24, -10, 230), 9.0F}});
  plan.push_back(trunk);
}

}  // namespace endovascular_sim::patient
