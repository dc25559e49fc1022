#include <algorithm>
#include <cmath>

#include "patient/body/anatomy_parts.h"
#include "patient/solid/counter_random.h"

namespace endovascular_sim::patient
{
namespace
{

/** Lung of one side: the inside of the rib cage, lateral of the mediastinum, above the dome of the diaphragm. */
class Lung : public Solid
{
public:
  explicit Lung(float side)
    : Solid(side > 0.0F ? Box(Point(0, -100, 50), Point(130, 95, 402)) : Box(Point(-130, -100, 50), Point(0, 95, 402))),
      side_(side)
  {
  }

  float distance(const Point& p) const override
  {
    const float x = side_ * p.x(), z = p.z();
    const float front = front_.at(z), back = back_.at(z), b = 0.5F * (back - front), a = width_.at(z);
    const float u = x / a, v = (p.y() - 0.5F * (front + back)) / b;
    const float level = std::sqrt(u * u + v * v);
    const float gradient = std::max(std::sqrt(u * u / (a * a) + v * v / (b * b)), 1e-4F);
    const float wall = level * (level - 1.0F) / gradient;
    const float mediastinum = mediastinum_.at(p.y()) + widening_.at(z) - x;
    return std::max({wall, mediastinum, 0.8F * (dome(x, p.y()) - z)});
  }

private:
  /** Height of the diaphragm. */
  float dome(float x, float y) const
  {
    const float top = side_ < 0.0F ? 142.0F : 129.0F;
    const float dx = x - 58.0F, dy = y + 22.0F;
    return top - (dx > 0.0F ? 0.0115F : 0.004F) * dx * dx - (dy > 0.0F ? 0.0058F : 0.0030F) * dy * dy;
  }

  float side_;
  Profile width_{{{40, 116},
                  {100, 121},
                  {130, 123},
                  {165, 124},
                  {200, 122},
                  {242, 115},
                  {280, 103},
                  {318, 84},
                  {345, 65},
                  {372, 43},
                  {386, 26},
                  {394, 10},
                  {400, 1}}};
  Profile front_{
      {{40, -70}, {130, -84}, {200, -87}, {242, -84}, {280, -74}, {318, -58}, {345, -42}, {372, -20}, {400, 15}}};
  Profile back_{{{40, 55}, {80, 62}, {130, 74}, {222, 80}, {300, 70}, {345, 58}, {372, 46}, {400, 24}}};
  Profile mediastinum_{{{-110, 4}, {-75, 6}, {-55, 11}, {-20, 22}, {15, 22}, {38, 17}, {55, 14}, {75, 16}, {100, 22}}};
  Profile widening_{{{50, -2}, {130, 0}, {190, 3}, {235, 8}, {270, 6}, {310, 7}, {350, 2}, {400, -5}}};
};

/** Branching vessels from the hilum. */
class VesselTree
{
public:
  VesselTree(BodyPart& part, float side, std::uint64_t seed)
    : part_(part), side_(side), random_(seed, side > 0.0F ? 11 : 12)
  {
  }

  void addStem()
  {
    const float angle = random_.uniform(-2.2F, 1.6F);
    const Point direction(side_ * (0.9F * std::cos(angle) + 0.35F), 0.5F * random_.normal(), std::sin(angle));
    const Point hilum(side_ * 30.0F + 3.0F * random_.normal(), 16.0F + 5.0F * random_.normal(),
                      238.0F + 8.0F * random_.normal());
    grow(hilum, direction.normalized(), random_.uniform(3.4F, 5.8F), 0);
  }

private:
  void grow(const Point& begin, const Point& direction, float radius, int depth)
  {
    if (radius < 0.75F || depth > 8)
      return;
    const Point end = begin + direction * radius * random_.uniform(4.5F, 7.5F);
    if (std::abs(end.x()) > 120.0F || end.z() < 60.0F || end.z() > 385.0F)
      return;
    part_.solids.push_back(capsule(begin, end, radius, 0.85F * radius));
    for (int child = 0; child < 2; ++child)
    {
      const Point turn(random_.normal(), random_.normal(), random_.normal());
      const Point next = direction + 0.5F * turn + Point(0.12F * side_, 0.0F, 0.0F);
      grow(end, next.normalized(), radius * random_.uniform(0.66F, 0.85F), depth + 1);
    }
  }

  BodyPart& part_;
  float side_;
  CounterRandom random_;
};

void addAirways(BodyPlan& plan)
{
  const Point carina(-15, 26, 282);
  BodyPart part{replacing(Tissue::kAir, 1.0F), {}, {}};
  addChain(part.solids,
           {{Point(0, 0, 470), 8.5F}, {Point(-4, 8, 400), 8.5F}, {Point(-11, 18, 340), 8.0F}, {carina, 8.0F}});
  addChain(part.solids, {{carina, 6.5F}, {Point(-30, 27, 262), 6.0F}, {Point(-42, 26, 238), 4.5F}});
  addChain(part.solids,
           {{carina, 6.0F}, {Point(10, 26, 256), 5.0F}, {Point(34, 27, 244), 4.5F}, {Point(46, 27, 228), 3.8F}});
  plan.push_back(part);
}

}  // namespace

void addLungs(BodyPlan& plan, std::uint64_t seed)
{
  for (const float side : {1.0F, -1.0F})
  {
    const SolidPointer lung = std::make_shared<Lung>(side);
    plan.push_back({replacing(Tissue::kLung, 1.0F), {lung}, {}});
    BodyPart vessels{denser(Tissue::kMuscle, 0.5F), {}, {}};
    VesselTree tree(vessels, side, seed);
    for (int i = 0; i < 18; ++i)
      tree.addStem();
    plan.push_back(vessels);
  }
  addAirways(plan);
}

}  // namespace endovascular_sim::patient
