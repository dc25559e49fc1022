#include <array>
#include <cmath>

#include "patient/body/anatomy_parts.h"

namespace endovascular_sim::patient
{
namespace
{

/** Shape of a pair of ribs [mm, degrees]. */
struct Rib
{
  float half_width;  ///< largest distance from the median plane
  float front;       ///< y of the foremost point of the rib's ellipse
  float drop;        ///< descent from the spine to the front
  float last_angle;  ///< around the ellipse, from the spine
};

constexpr std::array<Rib, 12> kRibs{{{56, -46, 30, 150},
                                     {78, -60, 47, 150},
                                     {97, -72, 62, 150},
                                     {110, -82, 76, 150},
                                     {119, -88, 88, 150},
                                     {126, -93, 97, 150},
                                     {131, -96, 104, 150},
                                     {134, -96, 107, 146},
                                     {134, -93, 106, 138},
                                     {130, -84, 98, 126},
                                     {121, -70, 80, 92},
                                     {110, -60, 60, 62}}};

/** Point of a rib at an angle from the spine. */
Point ribPoint(const Rib& rib, float side, float y, float z, float angle)
{
  const float back = y + 24.0F, half_depth = 0.5F * (back - rib.front);
  const float s = std::sin(angle), c = std::cos(angle);
  const float descent = rib.drop * 0.5F * (1.0F - c) * (0.7F + 0.17F * angle);
  return {side * ((rib.half_width - 6.0F) * s + 8.0F * c * s), back - half_depth + half_depth * c, z - descent};
}

void addRib(BodyPlan& plan, const Rib& rib, float side, float y, float z)
{
  constexpr int kPieces = 48;
  BodyPart part{bone(1450.0F, 1.1F, 200.0F), {}, {}};
  const float first = 0.14F, last = rib.last_angle * 0.0174533F;
  Point previous = ribPoint(rib, side, y, z, first);
  // Head: from the vertebral body to the first point.
  part.solids.push_back(capsule(Point(side * 16.0F, y + 10.0F, z + 2.0F), previous, 4.2F, 4.0F));
  for (int i = 1; i <= kPieces; ++i)
  {
    const float t = static_cast<float>(i) / kPieces;
    const Point next = ribPoint(rib, side, y, z, first + (last - first) * t);
    const float half_height = 5.2F + 1.6F * t;
    part.solids.push_back(flatCapsule(previous, next, 3.0F, half_height, Point::UnitZ()));
    previous = next;
  }
  plan.push_back(part);
}

/** Cartilage from the end of a rib to the sternum. */
void addCartilage(BodyPlan& plan, int index, float side, const Point& end)
{
  const float t = static_cast<float>(index) / 6.0F;
  const Point sternum(side * 14.0F, -64.0F - 34.0F * t, 340.0F - 150.0F * t);
  const Point middle = 0.5F * (end + sternum) + Point(0.0F, -6.0F, -6.0F);
  plan.push_back(
      {denser(Tissue::kCartilage, 1.0F), {capsule(end, middle, 5.5F, 5.5F), capsule(middle, sternum, 5.5F, 5.0F)}, {}});
}

void addSternum(BodyPlan& plan)
{
  BodyPart part{bone(1150.0F, 1.1F, 180.0F), {}, {}};
  const Point top(0, -60, 347), angle(0, -79, 300), end(0, -98, 196);
  for (const float u : {-1.0F, -0.5F, 0.0F, 0.5F, 1.0F})
  {
    part.solids.push_back(
        capsule(top + Point(20.0F * u, 0, -4.0F * (1.0F - u * u)), angle + Point(13.0F * u, 0, 2), 5.0F, 4.5F));
    part.solids.push_back(capsule(angle + Point(12.0F * u, -1, -3), end + Point(14.0F * u, 0, 0), 4.5F, 4.2F));
  }
  part.solids.push_back(capsule(end, end + Point(0, 3, -26), 4.0F, 2.5F));
  plan.push_back(part);
}

}  // namespace

void addRibCage(BodyPlan& plan, const SpineCurve& spine)
{
  for (int i = 0; i < 12; ++i)
  {
    const Vertebra& v = vertebra("T" + std::to_string(i + 1));
    const Rib& rib = kRibs[static_cast<std::size_t>(i)];
    const float z = v.centre + 0.45F * v.height, y = spine.y(z);
    for (const float side : {1.0F, -1.0F})
    {
      addRib(plan, rib, side, y, z);
      if (i < 7)
        addCartilage(plan, i, side, ribPoint(rib, side, y, z, rib.last_angle * 0.0174533F));
    }
  }
  addSternum(plan);
}

}  // namespace endovascular_sim::patient
