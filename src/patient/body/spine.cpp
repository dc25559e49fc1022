#include "patient/body/spine.h"

#include <algorithm>
#include <cmath>

#include "patient/body/anatomy_parts.h"

namespace endovascular_sim::patient
{
namespace
{

constexpr float kClearance = 3.0F;         // between the lumen and a vertebral body [mm]
constexpr float kMaxDisplacement = 40.0F;  // [mm]
constexpr float kSteepest = 0.12F;         // change of the displacement per height

const Profile& usualCurve()
{
  static const Profile profile({{-90, 60},
                                {-60, 38},
                                {-36, 29},
                                {0, 31},
                                {45, 39},
                                {88, 50},
                                {130, 62},
                                {180, 67},
                                {222, 66},
                                {300, 57},
                                {350, 49},
                                {390, 37},
                                {420, 28},
                                {460, 22}});
  return profile;
}

/** Displacement that keeps all points of the vessel in front of an elliptic body. */
float displacementOf(const Vertebra& vertebra, const std::vector<Point>& vessel)
{
  const float half_width = 0.5F * vertebra.width + kClearance, half_depth = 0.5F * vertebra.depth + kClearance;
  const float y = usualCurve().at(vertebra.centre);
  float displacement = 0.0F;
  for (const Point& p : vessel)
  {
    const float x = p.x() / half_width;
    if (std::abs(p.z() - vertebra.centre) > 0.5F * vertebra.height + 4.0F || std::abs(x) >= 1.0F ||
        p.y() > y + half_depth)
      continue;
    const float needed = p.y() - (y - half_depth * std::sqrt(1.0F - x * x));
    displacement = std::clamp(needed, displacement, kMaxDisplacement);
  }
  return displacement;
}

/** Body of a vertebra: elliptic cylinder with a waist, along the tilted axis of the spine. */
class VertebralBody : public Solid
{
public:
  VertebralBody(const Vertebra& v, float y, float slope)
    : Solid(Box(Point(-0.6F * v.width, y - 0.8F * v.depth, v.centre - 0.7F * v.height),
                Point(0.6F * v.width, y + 0.8F * v.depth, v.centre + 0.7F * v.height))),
      v_(v),
      y_(y),
      slope_(slope)
  {
  }

  float distance(const Point& p) const override
  {
    const float dz = p.z() - v_.centre, dy = p.y() - y_;
    const float along = (dz + slope_ * dy) / std::sqrt(1.0F + slope_ * slope_);
    const float u = along / (0.5F * v_.height);
    const float waist = 0.5F * (0.87F + 0.13F * std::min(u * u, 1.2F));
    const float a = waist * v_.width, b = waist * v_.depth;
    const float x = p.x() / a, y = (dy - slope_ * dz) / b;
    const float level = std::sqrt(x * x + y * y);
    const float gradient = std::sqrt(x * x / (a * a) + y * y / (b * b));
    const float side = gradient > 0.0F ? level * (level - 1.0F) / gradient : -b;
    // The endplates are slightly concave.
    const float sag = 1.2F * std::max(0.0F, 1.0F - level * level);
    return std::max(side, std::abs(along) - 0.5F * v_.height + sag);
  }

private:
  Vertebra v_;
  float y_, slope_;
};

/** Posterior elements on both sides: pedicle, articular, transverse processes and lamina. */
void addArch(BodyPart& part, const Vertebra& v, const Point& back, bool thoracic)
{
  const float h = v.height;
  for (const float side : {1.0F, -1.0F})
  {
    const float x = side * (0.5F * v.width - 0.5F * v.pedicle_width - 0.5F);
    const Point root = back + Point(x, -4.0F, 0.22F * h), pillar = back + Point(x, 14.0F, 0.16F * h);
    part.solids.push_back(flatCapsule(root, pillar, 0.5F * v.pedicle_width,
                                      std::max(0.5F * v.pedicle_height, 0.5F * v.pedicle_width), Point::UnitZ()));
    const Point tip =
        thoracic ? back + Point(x + side * 20.0F, 27.0F, 0.35F * h) : back + Point(x + side * 26.0F, 17.0F, 0.22F * h);
    part.solids.push_back(capsule(pillar, tip, 4.2F, thoracic ? 4.6F : 2.8F));
    part.solids.push_back(
        capsule(pillar + Point(0.0F, 1.0F, 0.30F * h), pillar + Point(-side * 2.0F, 4.0F, -0.75F * h), 4.6F, 4.4F));
    part.solids.push_back(flatCapsule(pillar + Point(0.0F, 3.0F, -0.05F * h), back + Point(0.0F, 24.0F, -0.2F * h),
                                      2.8F, 0.32F * h, Point::UnitZ()));
  }
}

/** Spinous process: a plate in the median plane, steep in the thorax. */
void addSpinousProcess(BodyPart& part, const Vertebra& v, const Point& back, bool thoracic)
{
  const Point begin = back + Point(0.0F, 23.0F, -0.2F * v.height);
  const Point end = begin + (thoracic ? Point(0.0F, 19.0F, -1.0F * v.height) : Point(0.0F, 26.0F, -0.25F * v.height));
  part.solids.push_back(flatCapsule(begin, end, 2.6F, thoracic ? 5.0F : 0.38F * v.height, Point::UnitZ()));
  part.solids.push_back(
      flatCapsule(end, end + Point(0.0F, 2.0F, -1.0F), 3.6F, thoracic ? 5.0F : 0.36F * v.height, Point::UnitZ()));
}

/** Displacements of all levels, with a limited change from level to level. */
std::vector<std::array<float, 2>> displacedNodes(const std::vector<Point>& vessel)
{
  std::vector<float> needed;
  for (const Vertebra& v : vertebrae())
    needed.push_back(displacementOf(v, vessel));
  const auto displacement = [&](float z)
  {
    float value = 0.0F;
    for (std::size_t i = 0; i < needed.size(); ++i)
      value = std::max(value, needed[i] - kSteepest * std::abs(z - vertebrae()[i].centre));
    return value;
  };
  std::vector<std::array<float, 2>> nodes;
  for (float z = -90.0F; z <= 460.0F; z += 10.0F)
    nodes.push_back({z, usualCurve().at(z) + displacement(z)});
  return nodes;
}

}  // namespace

const std::vector<Vertebra>& vertebrae()
{
  // Bodies and pedicles: mean values of M. M. Panjabi et al., Spine 16:888, 1991 (thoracic), 17:299, 1992 (lumbar) and
  // 16:861, 1991 (cervical), rounded. Discs: usual heights.
  static const std::vector<Vertebra> levels = []
  {
    std::vector<Vertebra> list{{"L5", 23, 47, 34.5, 15, 18, 11},       {"L4", 24, 46.5, 35, 13, 15.5, 11},
                               {"L3", 24, 44, 35, 10.2, 14.5, 10.5},   {"L2", 24.3, 42.5, 34.5, 8.5, 15, 9.5},
                               {"L1", 23.8, 41, 34, 8.6, 15.9, 8},     {"T12", 22.7, 39, 33, 8.8, 16, 6.5},
                               {"T11", 21.3, 35, 32, 9, 16.5, 5.5},    {"T10", 20.2, 32, 30.5, 7.5, 14.5, 5},
                               {"T9", 19.3, 30.5, 29.3, 7, 13.5, 5},   {"T8", 18.7, 29.5, 28, 6.3, 12.3, 4.5},
                               {"T7", 18.2, 28, 27.4, 6, 12, 4.5},     {"T6", 17.4, 26.2, 26, 5.6, 11.4, 4.5},
                               {"T5", 16.2, 25, 24.3, 5.4, 11, 4.5},   {"T4", 16.2, 24.5, 23.3, 5.2, 10.5, 4},
                               {"T3", 15.7, 24.6, 22.7, 5.6, 10.5, 4}, {"T2", 15.6, 25, 19.6, 6.8, 10.5, 4},
                               {"T1", 14.1, 24.5, 18.5, 8, 9.8, 4.5},  {"C7", 12.8, 22, 18, 6.5, 7.5, 5},
                               {"C6", 11.5, 19, 17.5, 6, 7.4, 5}};
    list[0].centre = -0.5F * (list[0].height + list[1].height) - list[0].disc;
    for (std::size_t i = 1; i < list.size(); ++i)
      list[i].centre = list[i - 1].centre + 0.5F * (list[i - 1].height + list[i].height) + list[i - 1].disc;
    return list;
  }();
  return levels;
}

const Vertebra& vertebra(const std::string& name)
{
  return *std::find_if(vertebrae().begin(), vertebrae().end(), [&](const Vertebra& v) { return v.name == name; });
}

SpineCurve::SpineCurve(const std::vector<Point>& vessel) : curve_(displacedNodes(vessel))
{
  for (const Vertebra& v : vertebrae())
    displacement_ = std::max(displacement_, y(v.centre) - usualCurve().at(v.centre));
}

void addVertebrae(BodyPlan& plan, const SpineCurve& spine)
{
  for (const Vertebra& v : vertebrae())
  {
    const bool thoracic = v.name[0] == 'T';
    const float y = spine.y(v.centre);
    BodyPart part{bone(1350.0F, 1.2F, 210.0F), {}, {}};
    part.solids.push_back(std::make_shared<VertebralBody>(v, y, spine.slope(v.centre)));
    const Point back(0.0F, y + 0.42F * v.depth, v.centre);
    addArch(part, v, back, thoracic);
    addSpinousProcess(part, v, back, thoracic);
    plan.push_back(part);
  }
}

}  // namespace endovascular_sim::patient
