#include "flow/measurement/pressure_line.h"

#include <stdexcept>

namespace endovascular_sim::flow
{

PressureLine::PressureLine(double frequency, double damping, double pressure)
  : omega_(2.0 * 3.14159265358979323846 * frequency), damping_(damping), reading_(pressure), pressure_(pressure)
{
  if (!(frequency > 0.0) || !(damping > 0.0))
    throw std::invalid_argument("pressure line: frequency and damping must be positive");
}

double PressureLine::step(double pressure, double time_step)
{
  // With y' = y + h/2 (r + r') and r' = r + h/2 (f + f'), f = ω²(p − y) − 2ζω r.
  const double half = 0.5 * time_step, square = omega_ * omega_, friction = 2.0 * damping_ * omega_;
  const double force = square * (pressure_ - reading_) - friction * rate_;
  const double rest = square * (pressure - reading_ - half * rate_);
  const double rate = (rate_ + half * (force + rest)) / (1.0 + half * friction + half * half * square);
  reading_ += half * (rate_ + rate);
  rate_ = rate;
  pressure_ = pressure;
  return reading_;
}

}  // namespace endovascular_sim::flow
