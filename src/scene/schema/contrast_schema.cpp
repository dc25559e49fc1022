#include <algorithm>

#include "common/text/format.h"
#include "contrast/medium/medium_viscosity.h"
#include "scene/schema/scene_schema.h"

namespace endovascular_sim::scene
{
namespace
{

const std::vector<std::string> kSyringes = {"hand", "pump"};  // in the order of SyringeKind

bool hasLumen(const DrivenInstrument& driven)
{
  return driven.instrument.inner_radius > 0.0;
}

/** Name of the outermost instrument with a lumen; empty without one. */
std::string outermostWithLumen(const Scene& scene)
{
  const auto found = std::find_if(scene.instruments.rbegin(), scene.instruments.rend(), &hasLumen);
  return found == scene.instruments.rend() ? "" : found->instrument.name;
}

void checkInstrument(const yaml::Fields& fields, const Scene& scene)
{
  const std::string& name = scene.contrast->instrument;
  if (name.empty())
    fields.reject("contrast", "no instrument of the scene has a lumen; add a catheter, or remove contrast");
  const auto found = std::find_if(scene.instruments.begin(), scene.instruments.end(),
                                  [&name](const DrivenInstrument& driven) { return driven.instrument.name == name; });
  if (found == scene.instruments.end())
    fields.reject("contrast.instrument", "the scene has no instrument '" + name + "'; name one with a lumen");
  if (!hasLumen(*found))
    fields.reject("contrast.instrument", "'" + name + "' has no lumen; name a catheter");
}

/** Rejects an injection before the end of the one before it, and one of which it is known that nothing is inside. */
void checkInjectionTimes(const yaml::Fields& fields, const Scene& scene)
{
  const ContrastScene& contrast = *scene.contrast;
  const DrivenInstrument& injecting = scene.instruments[scene.injectingInstrument()];
  const bool is_known = injecting.drive.source == DriveSource::kScript || injecting.drive.source == DriveSource::kNone;
  double end = 0.0;
  for (std::size_t k = 0; k < contrast.injections.size(); ++k)
  {
    const InjectionScene& one = contrast.injections[k];
    const std::string key = "contrast.injections." + std::to_string(k) + ".at";
    if (one.at < end)
      fields.reject(
          key, formatted("%g s lies before the end of the injection before, %g s; give a later time", one.at, end));
    if (is_known && injecting.drive.insertionAt(one.at) <= 0.0)
      fields.reject(key, formatted("'%s' is outside of the vessel at %g s; give a time at which it is inside",
                                   injecting.instrument.name.c_str(), one.at));
    end = one.at + contrast.injection(one.volume, one.rate, one.rise).duration();
  }
}

}  // namespace

void rejectInjection(const yaml::Fields& fields, const std::string& path, const std::string& refusal)
{
  const std::size_t name = refusal.find(' ');
  fields.reject(path + refusal.substr(0, name), refusal.substr(name + 1));
}

void visitInjection(yaml::Fields& fields, double& volume, double& rate, double& rise)
{
  fields.number("volume", volume, quantities::kInjectionVolume, Range::positive(), Need::kRequired);
  fields.number("rate", rate, quantities::kInjectionRate, Range::positive(), Need::kRequired);
  fields.number("rise", rise, quantities::kInjectionRise, Range::between(0.0, contrast::kLongestRise));
}

void visitContrast(yaml::Fields& fields, ContrastScene& contrast, const Scene& scene)
{
  if (fields.reading())
    contrast.instrument = outermostWithLumen(scene);
  fields.text("instrument", contrast.instrument);
  fields.number("concentration", contrast.concentration, quantities::kIodine,
                {0.0, contrast::kStrongestMedium, true, false});
  if (fields.reading())
    contrast.viscosity = contrast::mediumViscosity(contrast.concentration);
  fields.number("viscosity", contrast.viscosity, quantities::kMediumViscosity,
                Range::between(contrast::kLeastViscosity, contrast::kMostViscosity));
  fields.option("syringe", contrast.kind, kSyringes);
  if (fields.reading() || !contrast.injections.empty())
    fields.list(
        "injections", contrast.injections.size(), [&contrast](std::size_t size) { contrast.injections.resize(size); },
        [&contrast](yaml::Fields& keys, std::size_t k)
        {
          InjectionScene& one = contrast.injections[k];
          keys.number("at", one.at, quantities::kProfileTime, Range::nonNegative(), Need::kRequired);
          visitInjection(keys, one.volume, one.rate, one.rise);
        });
  if (!fields.reading())
    return;
  for (std::size_t k = 0; k < contrast.injections.size(); ++k)
  {
    const InjectionScene& one = contrast.injections[k];
    const std::string refusal = refusalOf(contrast.injection(one.volume, one.rate, one.rise), contrast.syringe());
    if (!refusal.empty())
      rejectInjection(fields, "injections." + std::to_string(k) + ".", refusal);
  }
}

void checkContrast(const yaml::Fields& fields, const Scene& scene)
{
  if (!scene.contrast)
    return;
  if (!scene.flow)
    fields.reject("contrast", "needs blood that flows; give flow, e.g. flow: adult, or remove contrast");
  if (scene.fluoroscopy && scene.fluoroscopy->iodine > 0.0)
    fields.reject("fluoroscopy.iodine",
                  "fills the vessel evenly, beside the contrast medium of an injection; remove it, or contrast");
  checkInstrument(fields, scene);
  checkInjectionTimes(fields, scene);
}

}  // namespace endovascular_sim::scene
