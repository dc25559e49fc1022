#pragma once

#include "common/archive.h"

namespace endovascular_sim::flow
{

/** Peripheral circulation behind an outlet: resistance R₁, then compliance C and resistance R₂ in parallel,
 *
 *      Q = (P − P_c)/R₁,   C dP_c/dt = Q − (P_c − P_b)/R₂   (Westerhof et al. 2009, the three-element windkessel).
 *
 *  P_b is the pressure at the end of R₂: that of the veins, or in the heart's muscle that of the muscle around them. */
struct Windkessel
{
  int node = 0;             ///< node of the network at the outlet
  double proximal = 0.0;    ///< R₁ [Pa·s/m³]
  double distal = 0.0;      ///< R₂ [Pa·s/m³]
  double compliance = 0.0;  ///< C [m³/Pa]
};

/** State of a windkessel. Over a time step its flow is a linear function of the new pressure P at its node,
 *  Q = slope·P + constant, by the implicit Euler method. */
class WindkesselState
{
public:
  /** @param pressure P_c at the beginning [Pa] */
  explicit WindkesselState(double pressure = 0.0) : pressure_(pressure) {}

  /** Begins a step.
   *  @param back P_b at its end [Pa]
   *  @param time_step [s] */
  void prepare(const Windkessel& outlet, double back, double time_step)
  {
    const double storage = outlet.compliance / time_step;
    sum_ = storage + 1.0 / outlet.proximal + 1.0 / outlet.distal;
    source_ = storage * pressure_ + back / outlet.distal;
    slope_ = (1.0 - 1.0 / (outlet.proximal * sum_)) / outlet.proximal;
    constant_ = -source_ / (sum_ * outlet.proximal);
  }

  double slope() const { return slope_; }        ///< [m³/(s·Pa)]
  double constant() const { return constant_; }  ///< [m³/s]

  /** Ends a step.
   *  @param pressure P at its end [Pa]
   *  @return Q [m³/s] */
  double accept(const Windkessel& outlet, double pressure)
  {
    pressure_ = (pressure / outlet.proximal + source_) / sum_;
    return slope_ * pressure + constant_;
  }

  void archive(Archive& archive) { archive(pressure_); }

private:
  double pressure_;  // P_c [Pa]
  double sum_ = 1.0, source_ = 0.0, slope_ = 0.0, constant_ = 0.0;
};

}  // namespace endovascular_sim::flow
