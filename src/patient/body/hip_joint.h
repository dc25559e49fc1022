#pragma once

namespace endovascular_sim::patient
{

/** Centre of the left hip joint and radius of the femoral head [mm]. The common femoral artery passes in front of the
 * head's inner third. */
constexpr float kHipX = 90.0F;
constexpr float kHipY = 2.0F;
constexpr float kHipZ = -172.0F;
constexpr float kHeadRadius = 23.5F;

}  // namespace endovascular_sim::patient
