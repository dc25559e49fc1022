#include <algorithm>

#include "patient/body/anatomy_parts.h"
#include "patient/body/torso.h"
#include "patient/solid/counter_random.h"

namespace endovascular_sim::patient
{
namespace
{

/** Kidneys and psoas muscles, outlined by retroperitoneal fat. */
void addRetroperitoneum(BodyPlan& plan, const SpineCurve& spine)
{
  for (const float side : {1.0F, -1.0F})
  {
    const float low = side < 0.0F ? 8.0F : 0.0F;  // the right kidney is lower
    const Point kidney(side * 58.0F, spine.y(85.0F) + 16.0F, 84.0F - low);
    plan.push_back({replacing(Tissue::kFat, 3.0F),
                    {ellipsoid(kidney, Point(38, 33, 70)),
                     capsule(Point(side * 36, spine.y(80.0F), 110), Point(side * 62, 10, -60), 30.0F, 30.0F)},
                    {}});
    plan.push_back({replacing(Tissue::kMuscle, 1.0F), {ellipsoid(kidney, Point(26, 21, 54))}, {}});
    BodyPart psoas{replacing(Tissue::kMuscle, 1.0F), {}, {}};
    addChain(psoas.solids, {{Point(side * 20, spine.y(110.0F), 120), 7.0F},
                            {Point(side * 34, spine.y(40.0F) + 3, 40), 18.0F},
                            {Point(side * 48, 28, -20), 22.0F},
                            {Point(side * 72, 2, -100), 17.0F},
                            {Point(side * 92, -22, -165), 13.0F}});
    plan.push_back(psoas);
  }
}

/** A chain of gas bubbles, as in the haustra of the colon. */
void addGas(BodyPart& part, CounterRandom& random, const Point& a, const Point& b, int bubbles, float radius)
{
  for (int i = 0; i < bubbles; ++i)
  {
    const float t = (static_cast<float>(i) + random.uniform(0.1F, 0.9F)) / static_cast<float>(bubbles);
    const Point shift(4.0F * random.normal(), 6.0F * random.normal(), 4.0F * random.normal());
    const float r = radius * random.uniform(0.55F, 1.05F);
    part.solids.push_back(ellipsoid(snapped(a + t * (b - a) + shift),
                                    snapped(Point(r * random.uniform(0.8F, 1.3F), r * random.uniform(0.5F, 0.9F), r))));
  }
}

}  // namespace

void addAbdomen(BodyPlan& plan, const SpineCurve& spine, std::uint64_t seed)
{
  addRetroperitoneum(plan, spine);
  BodyPart gas{replacing(Tissue::kAir, 2.0F), {}, {}};
  CounterRandom random(seed, 21);
  gas.solids.push_back(ellipsoid(Point(62, -30, 92), Point(31, 26, 17)));      // stomach
  addGas(gas, random, Point(-118, -20, -70), Point(-112, -10, 50), 7, 16.0F);  // ascending colon
  addGas(gas, random, Point(-105, -55, 48), Point(95, -60, 56), 9, 15.0F);     // transverse
  addGas(gas, random, Point(122, 5, 60), Point(116, -5, -70), 7, 13.0F);       // descending
  addGas(gas, random, Point(90, -20, -90), Point(10, 10, -120), 5, 11.0F);     // sigmoid
  addGas(gas, random, Point(5, 52, -115), Point(0, 58, -160), 3, 13.0F);       // rectum
  for (int i = 0; i < 16; ++i)
  {
    const Point centre(random.uniform(-80.0F, 80.0F), random.uniform(-75.0F, -35.0F), random.uniform(-120.0F, 35.0F));
    gas.solids.push_back(ellipsoid(
        snapped(centre),
        snapped(Point(random.uniform(5.0F, 16.0F), random.uniform(5.0F, 11.0F), random.uniform(4.0F, 10.0F)))));
  }
  plan.push_back(gas);
  plan.push_back(
      {replacing(Tissue::kUrine, 2.0F), {ellipsoid(Point(0, -30, -158), Point(42, 30, 26))}, {}});  // bladder
}

}  // namespace endovascular_sim::patient
