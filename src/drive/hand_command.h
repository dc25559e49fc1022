#pragma once

namespace endovascular_sim::drive
{

/** Command to the proximal end of one instrument for one step: a position. */
struct HandCommand
{
  double insertion = 0.0;  ///< insertion of the instrument [m]
  double rotation = 0.0;   ///< rotation of the handle [rad]
  double pressure = 0.0;   ///< pressure at the inflator of its balloon [Pa]
};

/** Motion of the proximal end of one instrument in a step: a difference of positions. */
struct HandIncrement
{
  double insertion = 0.0;  ///< [m]
  double rotation = 0.0;   ///< [rad]
};

}  // namespace endovascular_sim::drive
