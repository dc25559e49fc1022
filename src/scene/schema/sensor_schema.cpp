#include <algorithm>
#include <string>
#include <vector>

#include "scene/schema/scene_schema.h"

// Schema of sensors: what each measures, and its errors.

namespace endovascular_sim::scene
{
namespace
{

using sensor::SensorKind;
using sensor::SensorSettings;

const std::vector<std::string> kKinds = {"em_tracker", "encoder", "force_sensor", "detector"};  // order of SensorKind

/** Components of an error with one key. */
struct ErrorKey
{
  const char* key;
  std::size_t first;  ///< index of the first component
  int size;           ///< number of components
  const Quantity& quantity;
};

std::vector<ErrorKey> errorKeys(SensorKind kind)
{
  switch (kind)
  {
    case SensorKind::kEmTracker:
      return {{"position", 0, 3, quantities::kPositionError}, {"angle", 3, 3, quantities::kAngleError}};
    case SensorKind::kEncoder:
      return {{"insertion", 0, 1, quantities::kPositionError}, {"rotation", 1, 1, quantities::kAngleError}};
    case SensorKind::kForceSensor:
      return {{"force", 0, 1, quantities::kForceError}, {"torque", 1, 1, quantities::kTorqueError}};
    case SensorKind::kDetector:
      return {{"pixels", 0, 2, quantities::kPixelError}};
  }
  return {};
}

/** One standard deviation per key, for all of its components. */
void visitNoise(yaml::Fields& fields, SensorSettings& settings)
{
  for (const ErrorKey& error : errorKeys(settings.kind))
  {
    double deviation = settings.noise[error.first];
    fields.number(error.key, deviation, error.quantity, Range::nonNegative());
    for (int k = 0; k < error.size; ++k)
      settings.noise[error.first + static_cast<std::size_t>(k)] = deviation;
  }
}

void visitBias(yaml::Fields& fields, SensorSettings& settings)
{
  for (const ErrorKey& error : errorKeys(settings.kind))
  {
    double* bias = &settings.bias[error.first];
    if (error.size == 1)
      fields.number(error.key, *bias, error.quantity, Range::any());
    else
      fields.numbers(error.key, bias, error.size, error.quantity);
  }
}

void checkName(const yaml::Fields& fields, const std::vector<SensorSettings>& sensors, std::size_t k)
{
  const std::string& name = sensors[k].name;
  if (!isTopicName(name))
    fields.reject("name", "names topics; must consist of letters, digits and _, with a letter first");
  for (std::size_t other = 0; other < k; ++other)
    if (sensors[other].name == name)
      fields.reject("name", "'" + name + "' is the name of sensors." + std::to_string(other) +
                                " too; give each sensor another name");
}

/** Rejects a detector that does not stand still. */
void checkDetector(const yaml::Fields& fields, const Scene& scene)
{
  if (!scene.fluoroscopy)
    fields.reject("kind", "is detector, but the scene has no fluoroscopy; add `fluoroscopy: {isocentre: [X, Y, Z]}`");
  if (!scene.fluoroscopy->isocentre)
    fields.reject("kind",
                  "is detector, which stands still at the scene's pose of the C-arm; give fluoroscopy.isocentre");
}

void visitSensor(yaml::Fields& fields, Scene& scene, std::size_t k)
{
  SensorSettings& settings = scene.sensors[k];
  fields.text("name", settings.name, Need::kRequired);
  fields.option("kind", settings.kind, kKinds, Need::kRequired);
  visitInstrumentName(fields, scene, settings.instrument);
  const double fastest = 1.0 / scene.solver.time_step;
  if (settings.rate == 0.0)
    settings.rate = fastest;
  fields.number("rate", settings.rate, quantities::kRate, Range::positive());
  fields.number("delay", settings.delay, quantities::kDelay, Range::nonNegative());
  fields.number("drop_out", settings.drop_out, quantities::kFraction, Range::between(0.0, 1.0));
  fields.map("noise", [&settings](yaml::Fields& noise) { visitNoise(noise, settings); });
  fields.map("bias", [&settings](yaml::Fields& bias) { visitBias(bias, settings); });
  fields.bigInteger("seed", settings.seed);
  if (!fields.reading())
    return;
  checkName(fields, scene.sensors, k);
  if (settings.rate > fastest * (1.0 + 1e-9))
    fields.reject("rate", "is more than one sample per step; must be at most 1/solver.time_step, " +
                              std::to_string(fastest) + " Hz");
  if (settings.kind == SensorKind::kDetector)
    checkDetector(fields, scene);
}

}  // namespace

void visitInstrumentName(yaml::Fields& fields, const Scene& scene, std::size_t& instrument)
{
  std::vector<std::string> names;
  for (const DrivenInstrument& driven : scene.instruments)
    names.push_back(driven.instrument.name);
  std::string name = names[instrument];
  fields.text("instrument", name, names.size() > 1 ? Need::kRequired : Need::kOptional);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
  {
    std::string known;
    for (const std::string& one : names)
      known += (known.empty() ? "" : ", ") + one;
    fields.reject("instrument", "the scene has no instrument '" + name + "'; it has " + known);
  }
  instrument = static_cast<std::size_t>(found - names.begin());
}

void visitSensors(yaml::Fields& fields, Scene& scene)
{
  fields.list(
      "sensors", scene.sensors.size(), [&scene](std::size_t size) { scene.sensors.resize(size); },
      [&scene](yaml::Fields& sensor, std::size_t k) { visitSensor(sensor, scene, k); }, Need::kRequired);
}

}  // namespace endovascular_sim::scene
