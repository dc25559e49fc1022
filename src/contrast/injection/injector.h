#pragma once

#include "contrast/injection/injection.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::contrast
{

/** Contrast medium that leaves a syringe in a time step. */
struct Dose
{
  double volume = 0.0;         ///< [m³]
  double concentration = 0.0;  ///< iodine [kg/m³]
  double viscosity = 0.0;      ///< [Pa·s]
};

/** Syringe that gives injections over time steps. The volumes of its steps add up to that of the injection, whatever
 *  the steps are. */
class Injector
{
public:
  explicit Injector(const Syringe& syringe) : syringe_(syringe), content_(syringe.capacity) {}

  /** Begins an injection. The present injection ends, and its remaining volume stays in the syringe.
   *  @throws std::invalid_argument for one that refusalOf() names impossible */
  void start(const Injection& injection);

  /** Ends the injection; the rest stays in the syringe. */
  void stop();

  /** Fills the syringe to its capacity. */
  void refill() { content_ = syringe_.capacity; }

  /** Advances by a time step [s]. */
  Dose advance(double time_step);

  bool isActive() const { return left() > 0.0; }
  double left() const { return injection_.volume - given_; }  ///< of the injection [m³]
  double content() const { return content_; }                 ///< of the syringe [m³]
  const Syringe& syringe() const { return syringe_; }
  const Injection& injection() const { return injection_; }  ///< the present one, or the last that ended by itself

  /** @throws ArchiveError for values that no injector has */
  void archive(Archive& archive);

private:
  Syringe syringe_;
  Injection injection_;
  double content_;        // [m³]
  double elapsed_ = 0.0;  // since the beginning of the injection [s]
  double given_ = 0.0;    // of the injection [m³]
};

}  // namespace endovascular_sim::contrast
