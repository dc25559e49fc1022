#include <array>

#include "patient/body/anatomy_parts.h"
#include "patient/body/hip_joint.h"

namespace endovascular_sim::patient
{
namespace
{

Point mirrored(float side, float x, float y, float z)
{
  return {side * x, y, z};
}

/** Segment of the sacrum. */
struct SacralLevel
{
  float y, z, ala, body;
};

constexpr std::array<SacralLevel, 5> kSacrum{
    {{42, -62, 52, 23}, {60, -82, 46, 19}, {75, -102, 37, 16}, {84, -120, 29, 13}, {87, -136, 21, 11}}};

void addSacrum(BodyPlan& plan)
{
  BodyPart part{bone(1300.0F, 1.3F, 230.0F), {}, {}};
  for (std::size_t i = 0; i < kSacrum.size(); ++i)
  {
    const SacralLevel& s = kSacrum[i];
    const float thickness = 14.0F - 1.6F * static_cast<float>(i);
    part.solids.push_back(ellipsoid(Point(0, s.y, s.z), Point(s.ala, thickness, 13)));
    part.solids.push_back(ellipsoid(Point(0, s.y - 2, s.z + 1), Point(s.body, thickness + 3, 12)));
    part.solids.push_back(
        capsule(Point(0, s.y + 12, s.z), Point(0, s.y + 20 - 2.0F * static_cast<float>(i), s.z - 6), 4.0F, 3.0F));
    if (i == 0)
      continue;
    const SacralLevel& above = kSacrum[i - 1];
    for (const float side : {1.0F, -1.0F})  // foramina, normal to the front of the sacrum
    {
      const Point middle(side * (0.5F * (s.body + above.body) + 3.0F), 0.5F * (s.y + above.y), 0.5F * (s.z + above.z));
      const Point normal(0.0F, 0.7F, 0.7F);
      part.holes.push_back(
          capsule(middle - 20.0F * normal, middle + 20.0F * normal, 5.4F - 0.7F * static_cast<float>(i), 4.0F));
    }
  }
  addChain(part.solids, {{Point(0, 84, -148), 8.0F}, {Point(0, 78, -160), 6.0F}, {Point(0, 66, -172), 4.0F}});
  plan.push_back(part);
}

/** Points of a Catmull–Rom spline, four per interval. */
std::vector<Point> refined(const std::array<Point, 5>& nodes)
{
  std::vector<Point> points;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
    for (int k = 0; k < 4; ++k)
    {
      const Point &a = nodes[i == 0 ? 0 : i - 1], &b = nodes[i], &c = nodes[i + 1];
      const Point& d = nodes[i + 2 < nodes.size() ? i + 2 : i + 1];
      const float t = 0.25F * static_cast<float>(k);
      points.emplace_back(b +
                          0.5F * t * (c - a + t * (2.0F * a - 5.0F * b + 4.0F * c - d + t * (3.0F * (b - c) + d - a))));
    }
  points.push_back(nodes.back());
  return points;
}

/** Plates between two lines of equally many points. */
void addStrip(BodyPart& part, const std::vector<Point>& a, const std::vector<Point>& b, float half_thickness)
{
  for (std::size_t i = 0; i + 1 < a.size(); ++i)
  {
    part.solids.push_back(plate(a[i], a[i + 1], b[i], half_thickness));
    part.solids.push_back(plate(b[i], b[i + 1], a[i + 1], half_thickness));
  }
}

/** Thickened edge along a line of points. */
void addRim(BodyPart& part, const std::vector<Point>& points, float radius)
{
  std::vector<std::pair<Point, float>> chain;
  for (const Point& p : points)
    chain.emplace_back(p, radius);
  addChain(part.solids, chain);
}

/** Wing of the ilium: a curved plate between the crest and the line from the sacroiliac joint to the anterior spine. */
void addIliacWing(BodyPart& part, float side)
{
  const std::array<Point, 5> crest{mirrored(side, 44, 90, -72), mirrored(side, 66, 72, -28),
                                   mirrored(side, 102, 40, -6), mirrored(side, 134, -2, -24),
                                   mirrored(side, 126, -44, -76)};
  const std::array<Point, 5> base{mirrored(side, 46, 80, -98), mirrored(side, 58, 56, -102),
                                  mirrored(side, 74, 30, -118), mirrored(side, 92, 8, -138),
                                  mirrored(side, 106, -30, -120)};
  std::array<Point, 5> middle;
  for (std::size_t i = 0; i < 5; ++i)
    middle[i] = 0.5F * (crest[i] + base[i]) + mirrored(side, i < 2 ? 0.0F : 7.0F, i < 2 ? 0.0F : 7.0F, 0.0F);
  const std::vector<Point> top = refined(crest), centre = refined(middle), bottom = refined(base);
  addStrip(part, top, centre, 2.6F);
  addStrip(part, centre, bottom, 3.6F);
  addRim(part, top, 5.2F);
  addRim(part, bottom, 5.0F);
  part.solids.push_back(capsule(crest[4], base[4], 5.0F, 6.0F));
}

/** Pubis and ischium around the obturator foramen. */
void addObturatorRing(BodyPart& part, float side)
{
  // Arcuate line and superior ramus, behind the external iliac artery.
  addChain(part.solids, {{mirrored(side, 56, 54, -98), 5.0F},
                         {mirrored(side, 71, 28, -118), 5.5F},
                         {mirrored(side, 80, 8, -140), 7.0F},
                         {mirrored(side, 76, -12, -160), 8.0F},
                         {mirrored(side, 52, -34, -176), 6.5F},
                         {mirrored(side, 22, -50, -182), 7.0F}});
  part.solids.push_back(ellipsoid(mirrored(side, 13, -50, -190), Point(9, 8, 17)));
  addChain(part.solids, {{mirrored(side, 13, -46, -200), 6.0F},
                         {mirrored(side, 30, -26, -214), 5.0F},
                         {mirrored(side, 54, 12, -232), 7.5F}});
  addChain(part.solids, {{mirrored(side, 84, 22, -178), 14.0F},
                         {mirrored(side, 70, 30, -206), 12.5F},
                         {mirrored(side, 60, 22, -230), 13.0F}});
  part.solids.push_back(
      capsule(mirrored(side, 80, 42, -178), mirrored(side, 62, 52, -182), 5.0F, 3.0F));  // ischial spine
}

}  // namespace

void addPelvis(BodyPlan& plan)
{
  addSacrum(plan);
  for (const float side : {1.0F, -1.0F})
  {
    BodyPart part{bone(1450.0F, 1.3F, 260.0F), {}, {}};
    addIliacWing(part, side);
    addObturatorRing(part, side);
    const Point hip = mirrored(side, kHipX, kHipY, kHipZ);
    part.solids.push_back(
        shellCap(hip, kHeadRadius + 3.0F, kHeadRadius + 9.0F, mirrored(side, -0.62F, 0.15F, 0.75F), -2.0F));
    part.solids.push_back(ellipsoid(hip + mirrored(side, 2, 4, 30), Point(24, 24, 20)));
    part.holes.push_back(ellipsoid(hip, Point::Constant(kHeadRadius + 3.0F)));
    plan.push_back(part);
  }
}

}  // namespace endovascular_sim::patient
