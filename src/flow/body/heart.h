#pragma once

#include "flow/body/circulation.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::flow
{

/** Left heart: ejection into the aorta, and pressure in the left ventricle. The phase counts beats, so that the rate
 * may change at any time; at a rate of zero it stands still in diastole. */
class Heart
{
public:
  explicit Heart(const HeartSettings& settings) : settings_(settings), rate_(settings.rate) {}

  /** @param rate [Hz]; 0: arrest at the end of the present beat */
  void setRate(double rate) { rate_ = rate; }
  double rate() const { return rate_; }  ///< [Hz]

  /** Advances by a time step [s]. */
  void advance(double time_step);

  /** Phase of the beat, from 0 at the opening of the aortic valve to 1 [1]. */
  double phase() const { return phase_; }
  unsigned beats() const { return beats_; }  ///< complete ones

  /** Flow through the aortic valve [m³/s]; negative while it closes. */
  double inflow() const;
  /** The same against a pressure: above two thirds of the largest pressure less is ejected, in proportion to what is
   *  left to that pressure. @param root pressure in the aortic root [Pa] */
  double inflow(double root) const;
  /** Contraction of the ventricle: 0 in diastole, 1 while the aortic valve is open. */
  double activation() const;
  /** Pressure in the left ventricle [Pa]. @param root pressure in the aortic root [Pa] */
  double ventricle(double root) const
  {
    return settings_.filling_pressure + activation() * (root - settings_.filling_pressure);
  }

  /** Duration of the ejection at a rate: 413 ms − 1.7 ms per beat and minute (Weissler, Harris & Schoenfeld 1968) [s].
   *  @param rate [Hz] */
  static double ejectionTime(double rate);
  double strokeVolume() const;  ///< net volume of a beat [m³]

  void archive(Archive& archive);

private:
  double beatTime() const;  ///< time since the opening of the valve [s]
  double period() const;    ///< of the present beat [s]

  HeartSettings settings_;
  double rate_;
  double beat_rate_ = 0.0;  ///< rate of the present beat [Hz]; 0 before the first one
  double phase_ = 0.0;
  unsigned beats_ = 0;
};

}  // namespace endovascular_sim::flow
