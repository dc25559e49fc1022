#include <cmath>

#include "fluoroscopy/gantry/view.h"
#include "scene/schema/scene_schema.h"

// Schema of the pose of a C-arm, of its collimated field and of the limits of its gantry.

namespace endovascular_sim::scene
{
namespace
{

constexpr double kSmallestField = 0.02;  // [m]

void visitRange(yaml::Fields& fields, const std::string& key, fluoroscopy::LengthRange& range, const Quantity& quantity)
{
  double values[2] = {range.min, range.max};
  fields.numbers(key, values, 2, quantity);
  range = {values[0], values[1]};
  if (fields.reading() && !(range.min > 0.0 && range.min <= range.max))
    fields.reject(key, "must be [smallest, largest], both positive [m]");
}

void visitGantryLimits(yaml::Fields& fields, fluoroscopy::GantryLimits& limits)
{
  fields.number("primary_limit", limits.primary, quantities::kImagingAngle, Range::between(0.0, M_PI));
  fields.number("secondary_limit", limits.secondary, quantities::kImagingAngle, Range::between(0.0, 0.5 * M_PI));
  fields.number("angular_speed", limits.angular_speed, quantities::kGantryAngularSpeed, Range::positive());
  visitRange(fields, "source_to_detector", limits.source_to_detector, quantities::kSourceToDetector);
  visitRange(fields, "source_to_patient", limits.source_to_patient, quantities::kSourceToPatient);
  fields.number("detector_speed", limits.detector_speed, quantities::kSpeed, Range::positive());
  fields.number("clearance", limits.clearance, quantities::kClearance, Range::nonNegative());
  fields.vector3("table_stroke", limits.table_stroke, quantities::kStroke);
  if (fields.reading() && !(limits.table_stroke.minCoeff() >= 0.0))
    fields.reject("table_stroke", "must not be negative; 0 holds an axis");
  fields.number("table_speed", limits.table_speed, quantities::kSpeed, Range::positive());
}

void visitField(yaml::Fields& fields, FluoroscopyScene& fluoroscopy)
{
  if (!(fields.reading() ? fields.has("field") : fluoroscopy.field_width != 0.0 || fluoroscopy.field_height != 0.0))
    return;
  double sides[2] = {fluoroscopy.field_width, fluoroscopy.field_height};
  fields.numbers("field", sides, 2, quantities::kDetectorWidth);
  fluoroscopy.field_width = sides[0];
  fluoroscopy.field_height = sides[1];
  for (const double side : sides)
    if (fields.reading() && side != 0.0 && !(side >= kSmallestField && side <= fluoroscopy.detector_width))
      fields.reject("field", "must be [width, height] between 0.02 m and detector_width; 0 opens the collimator");
}

}  // namespace

void visitAngulation(yaml::Fields& fields, FluoroscopyScene& fluoroscopy)
{
  const Range turn = Range::between(-M_PI, M_PI);
  if (!(fields.reading() ? fields.has("view") : !fluoroscopy.view.empty()))
  {
    fields.number("primary_angle", fluoroscopy.primary_angle, quantities::kImagingAngle, turn);
    fields.number("secondary_angle", fluoroscopy.secondary_angle, quantities::kImagingAngle, turn);
    return;
  }
  fields.text("view", fluoroscopy.view);
  if (!fields.reading())
    return;
  for (const char* key : {"primary_angle", "secondary_angle"})
    if (fields.has(key))
      fields.reject(key, "conflicts with view; keep one of the two");
  const std::optional<fluoroscopy::View> view = fluoroscopy::parseView(fluoroscopy.view);
  if (!view)
    fields.reject("view", fluoroscopy::unknownView(fluoroscopy.view));
  fluoroscopy.primary_angle = view->primary_angle;
  fluoroscopy.secondary_angle = view->secondary_angle;
}

void visitGantry(yaml::Fields& fields, FluoroscopyScene& fluoroscopy)
{
  // Defaults are not written: the texts and hashes of scenes without these keys stay as they are.
  visitField(fields, fluoroscopy);
  if (fields.reading() ? fields.has("gantry") : fluoroscopy.gantry != fluoroscopy::GantryLimits())
    fields.map("gantry", [&fluoroscopy](yaml::Fields& gantry) { visitGantryLimits(gantry, fluoroscopy.gantry); });
  if (!fields.reading())
    return;
  const fluoroscopy::CArmPose pose = fluoroscopy.pose();
  const std::optional<fluoroscopy::LimitViolation> violation =
      fluoroscopy::limitViolation(pose, pose.isocentre, fluoroscopy.gantry);
  if (violation)
    fields.reject(fields.has("view") && violation->key.find("angle") != std::string::npos ? "view" : violation->key,
                  violation->remedy + ", or change fluoroscopy.gantry");
}

void checkView(const yaml::Fields& fields, const std::string& key, const std::string& view, const Scene& scene)
{
  const std::optional<fluoroscopy::View> angles = fluoroscopy::parseView(view);
  if (!angles || !scene.fluoroscopy)
    return;
  fluoroscopy::CArmPose pose = scene.fluoroscopy->pose();
  pose.primary_angle = angles->primary_angle;
  pose.secondary_angle = angles->secondary_angle;
  if (const auto violation = fluoroscopy::limitViolation(pose, pose.isocentre, scene.fluoroscopy->gantry))
    fields.reject(key, violation->remedy + ", or change fluoroscopy.gantry");
}

}  // namespace endovascular_sim::scene
