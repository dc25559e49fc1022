#pragma once

/** Values of units in SI, and π. */
namespace endovascular_sim::units
{

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180.0;            ///< [rad]
constexpr double kMillimetre = 1e-3;               ///< [m]
constexpr double kInch = 0.0254;                   ///< [m]
constexpr double kFrench = kMillimetre / 3.0;      ///< diameter of one French [m]
constexpr double kAtmosphere = 101325.0;           ///< standard atmosphere [Pa]
constexpr double kMillimetreOfMercury = 133.3224;  ///< [Pa]
constexpr double kGravity = 9.80665;               ///< standard acceleration of free fall [m/s²]

}  // namespace endovascular_sim::units
