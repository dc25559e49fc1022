#include "patient/body/torso.h"

#include <algorithm>
#include <cmath>

#include "patient/body/anatomy_parts.h"

namespace endovascular_sim::patient
{
namespace
{

class TorsoOutline : public Solid
{
public:
  explicit TorsoOutline(float inset) : Solid(Box(Point(-195, -130, -390), Point(195, 140, 470))), inset_(inset) {}

  float distance(const Point& p) const override
  {
    const float z = p.z(), front = front_.at(z), back = back_.at(z);
    const float a = width_.at(z) - inset_, b = 0.5F * (back - front) - inset_;
    const float x = std::abs(p.x()) / a, y = std::abs(p.y() - 0.5F * (front + back)) / b;
    const float rx = std::sqrt(x), ry = std::sqrt(y);
    const float level = x * x * rx + y * y * ry;
    const float gx = x * rx / a, gy = y * ry / b;
    return (level - 1.0F) / (2.5F * std::max(std::sqrt(gx * gx + gy * gy), 1e-3F));
  }

private:
  float inset_;
  Profile width_{{{-300, 172},
                  {-200, 174},
                  {-120, 170},
                  {-60, 160},
                  {0, 150},
                  {60, 149},
                  {120, 154},
                  {180, 161},
                  {240, 167},
                  {300, 178},
                  {335, 184},
                  {365, 158},
                  {392, 96},
                  {412, 68},
                  {440, 60},
                  {470, 60}}};
  Profile front_{{{-300, -80},
                  {-200, -95},
                  {-120, -100},
                  {-60, -99},
                  {0, -99},
                  {60, -103},
                  {120, -108},
                  {180, -114},
                  {240, -114},
                  {300, -104},
                  {340, -88},
                  {370, -70},
                  {400, -60},
                  {440, -58},
                  {470, -58}}};
  Profile back_{{{-300, 105},
                 {-200, 116},
                 {-120, 120},
                 {-60, 117},
                 {0, 116},
                 {60, 122},
                 {120, 130},
                 {180, 134},
                 {240, 133},
                 {300, 128},
                 {340, 120},
                 {370, 108},
                 {400, 92},
                 {440, 82},
                 {470, 80}}};
};

}  // namespace

SolidPointer torsoOutline(float inset)
{
  return std::make_shared<TorsoOutline>(inset);
}

void addTorso(BodyPlan& plan)
{
  plan.push_back({replacing(Tissue::kFat), {torsoOutline(0.0F)}, {}});
  plan.push_back({replacing(Tissue::kMuscle, 4.0F), {torsoOutline(15.0F)}, {}});
}

}  // namespace endovascular_sim::patient
