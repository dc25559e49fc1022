#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "contrast/injection/injector.h"
#include "flow/coupling/flow_source.h"
#include "flow/coupling/tree_path.h"
#include "instrument/instrument.h"
#include "scene/model/scene.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::simulation
{

/** Input of contrast medium before a step: an injection begins, or the present one ends. */
struct ContrastInput
{
  std::uint64_t step = 0;         ///< first step of the simulation that has it as input
  contrast::Injection injection;  ///< volume 0: the present one ends
  bool refill = false;            ///< the syringe is filled before
};

/** Injections of contrast medium through an instrument: the syringe, and what of it enters the vessel in each step of
 *  the flow. It leaves through the end hole and the side holes that lie in the vessel, in equal parts; those outside of
 *  it, or in the lumen of another instrument, give nothing. Without such an opening an injection ends. */
class ContrastInjections
{
public:
  /** @param scene with contrast and flow */
  explicit ContrastInjections(const scene::Scene& scene);

  int instrument() const { return instrument_; }  ///< index of the one that injects

  /** Reason for which an injection cannot begin, with its remedy; empty without one.
   *  @param refill the syringe is filled before
   *  @param insertions of all instruments [m] */
  std::string refusalOf(const contrast::Injection& injection, bool refill, const std::vector<double>& insertions) const;

  /** Follows an input: that of a call, or of a recording.
   *  @throws std::invalid_argument for an injection that the syringe does not give; nothing changes */
  void follow(const ContrastInput& input);

  /** Inputs of the newest step that had some, in their order; those of the scene are not among them. */
  const std::vector<ContrastInput>& inputs() const { return inputs_; }

  /** Medium that enters the vessel in the coming step of the flow. An injection of the scene that is due begins, with a
   *  syringe that is filled if it holds too little.
   *  @param time of its beginning [s]
   *  @param insertions of all instruments [m]
   *  @param path of the instrument from its tip to the introducer; called where something is injected */
  flow::FlowInjection advance(double time, const std::vector<double>& insertions,
                              const std::function<flow::TreePath()>& path);

  const contrast::Injector& injector() const { return injector_; }
  /** Iodine in the lumen of each instrument [kg/m³]. It is filled when its volume has been injected. */
  const std::vector<double>& lumens() const { return lumens_; }
  double rate() const { return rate_; }                ///< in the last step of the flow [m³/s]
  double injectedVolume() const { return injected_; }  ///< since the beginning of the run [m³]
  int missed() const { return missed_; }               ///< injections of the scene that found no opening in the vessel

  /** @throws ArchiveError for values that no injections have */
  void archive(Archive& archive);

private:
  std::vector<double> openings(const std::vector<double>& insertions) const;
  void beginDue(double time, bool has_opening);
  void fillLumen(const contrast::Dose& dose);

  scene::ContrastScene scene_;
  int instrument_;
  double time_step_;              ///< of the flow [s]
  std::vector<double> from_tip_;  ///< distances of the openings [m]
  double dead_volume_;            ///< of the instrument's lumen [m³]
  contrast::Injector injector_;
  std::vector<double> lumens_;  ///< [kg/m³]
  double medium_ = 0.0;         ///< iodine of the newest medium [kg/m³]
  double through_ = 0.0;        ///< volume of it that has been injected [m³]
  double rate_ = 0.0, injected_ = 0.0;
  std::uint64_t next_ = 0;  ///< of the scene's injections
  int missed_ = 0;
  std::vector<ContrastInput> inputs_;
};

}  // namespace endovascular_sim::simulation
