#include <array>
#include <cmath>

#include "scene/schema/scene_schema.h"

namespace endovascular_sim::scene
{
namespace
{

/** Friction coefficients of wet surfaces on a vessel wall: centres of the measured ranges of hydrophilic coatings
 *  (0.02–0.05), PTFE (0.08–0.15), and uncoated metal or polymer (0.2–0.3); see docs/SCENES.md. */
const std::vector<std::string> kSurfaces = {"hydrophilic", "ptfe", "bare"};
constexpr std::array<double, 3> kSurfaceFriction = {0.035, 0.115, 0.25};

/** A point that selects the nearest end may lie far away, e.g. below the patient for the lowest end. */
constexpr Quantity kSelectingPoint{"points that select an end", "m", Dimension::kLength, 0.0, 20.0, 0.0, 20.0};

const std::vector<std::string> kWallShapes = {"facets", "smooth"};  // order of contact::WallShape

/** Rotation from the frame of the mesh to the patient frame, from the directions head and left in the mesh frame. */
Eigen::Matrix3d rotationFromBody(yaml::Fields& fields)
{
  Eigen::Vector3d head = Eigen::Vector3d::Zero();
  Eigen::Vector3d left = Eigen::Vector3d::Zero();
  fields.vector3("head", head, quantities::kDirection, Need::kRequired);
  fields.vector3("left", left, quantities::kDirection, Need::kRequired);
  if (head.norm() < 1e-9 || left.norm() < 1e-9 || std::abs(head.normalized().dot(left.normalized())) > 1e-6)
    fields.reject("left", "must be a direction at right angles to head, e.g. head: [0, 1, 0] with left: [1, 0, 0]");
  Eigen::Matrix3d rotation;
  rotation.row(0) = left.normalized();
  rotation.row(2) = head.normalized();
  rotation.row(1) = head.normalized().cross(left.normalized());
  return rotation;
}

void visitTube(yaml::Fields& fields, vessel::TubeShape& tube)
{
  fields.number("radius", tube.radius, quantities::kVesselRadius, Range::positive(), Need::kRequired);
  if (fields.reading())
    tube.facet_length = tube.radius;
  fields.number("facet_length", tube.facet_length, quantities::kFacetLength, Range::positive());
  fields.integer("facets_around", tube.facets_around, 6, 1024);
  fields.list(
      "pieces", tube.pieces.size(), [&tube](std::size_t size) { tube.pieces.resize(size); },
      [&tube](yaml::Fields& piece_fields, std::size_t k)
      {
        vessel::TubePiece& piece = tube.pieces[k];
        piece_fields.number("length", piece.length, quantities::kVesselLength, Range::positive(), Need::kRequired);
        piece_fields.number("curvature", piece.curvature, quantities::kVesselCurvature, Range::nonNegative());
        piece_fields.number("plane_angle", piece.plane_angle, quantities::kAngle, Range::any());
        if (piece_fields.reading() && piece.curvature * tube.radius >= 1.0)
          piece_fields.reject("curvature", "exceeds the curvature limit of the tube; must be less than 1/radius");
      },
      Need::kRequired);
}

void visitMesh(yaml::Fields& fields, VesselScene& vessel)
{
  fields.text("mesh", vessel.mesh);
  if (fields.reading() && !fields.has("unit"))
    fields.reject("unit", "missing; give the metres per unit of the mesh file, e.g. 0.001 for millimetres");
  fields.number("unit", vessel.unit, quantities::kMeshUnit, Range::positive(), Need::kRequired);
  visitRotation(fields, vessel.transform);
  Eigen::Vector3d translation = vessel.transform.translation();
  fields.vector3("translation", translation, quantities::kPosition);
  vessel.transform.translation() = translation;
  fields.boolean("repair", vessel.repair);
  if (fields.reading() || !vessel.centreline.empty())
    fields.text("centreline", vessel.centreline);
}

void visitFrictionRegions(yaml::Fields& fields, VesselScene& vessel)
{
  std::vector<contact::WallLaw::FrictionRegion>& regions = vessel.friction_regions;
  if (!fields.reading() && regions.empty())
    return;
  fields.list(
      "friction_regions", regions.size(), [&regions](std::size_t size) { regions.resize(size); },
      [&regions](yaml::Fields& region, std::size_t k)
      {
        region.vector3("centre", regions[k].centre, quantities::kPosition, Need::kRequired);
        region.number("radius", regions[k].radius, quantities::kRegionRadius, Range::positive(), Need::kRequired);
        visitFriction(region, regions[k].friction, Need::kRequired);
      });
}

void visitPosition(yaml::Fields& keys, vessel::Lesion& lesion)
{
  if (keys.reading() ? keys.has("at") : lesion.at.has_value())
  {
    for (const char* other : {"branch", "from_start", "fraction"})
      if (keys.has(other))
        keys.reject(other, "conflicts with at; keep one of the two");
    Eigen::Vector3d at = lesion.at.value_or(Eigen::Vector3d::Zero());
    keys.vector3("at", at, quantities::kPosition, Need::kRequired);
    lesion.at = at;
    return;
  }
  keys.text("branch", lesion.branch, Need::kRequired);
  if (keys.has("from_start") && keys.has("fraction"))
    keys.reject("fraction", "conflicts with from_start; keep one of the two");
  keys.optionalNumber("from_start", lesion.from_start, quantities::kVesselLength, Range::nonNegative());
  if (std::isnan(lesion.from_start))
    keys.number("fraction", lesion.fraction, quantities::kFraction, Range::between(0.0, 1.0));
}

void visitLesions(yaml::Fields& fields, VesselScene& vessel)
{
  std::vector<vessel::Lesion>& lesions = vessel.lesions;
  if (!fields.reading() && lesions.empty())
    return;
  fields.list(
      "lesions", lesions.size(), [&lesions](std::size_t size) { lesions.resize(size); },
      [&lesions](yaml::Fields& keys, std::size_t k)
      {
        vessel::Lesion& lesion = lesions[k];
        visitPosition(keys, lesion);
        keys.number("length", lesion.length, quantities::kLesionLength, Range::positive(), Need::kRequired);
        keys.number("grade", lesion.grade, quantities::kFraction, Range::between(0.0, 0.99), Need::kRequired);
        keys.number("eccentricity", lesion.eccentricity, quantities::kFraction, Range::between(0.0, 1.0));
        keys.number("angle", lesion.angle, quantities::kAngle, Range::any());
      });
}

/** Rejects keys that apply to a mesh file only, with a more specific message than for unknown keys. */
void rejectMeshKeys(yaml::Fields& fields)
{
  for (const char* key : {"unit", "rotation", "head", "left", "translation", "repair", "centreline"})
    if (fields.has(key))
      fields.reject(key, "applies to a mesh file only; remove it, or give vessel.mesh");
}

void readDirection(yaml::Fields& fields, EntryScene& entry)
{
  fields.vector3("direction", entry.direction, quantities::kDirection);
  if (entry.direction.norm() < 1e-9)
    fields.reject("direction", "is zero; give a direction into the vessel, e.g. [0, 0, 1]");
  // A unit vector is not normalised again, so that the resolved text reads back to the same bits.
  if (std::abs(entry.direction.squaredNorm() - 1.0) > 1e-12)
    entry.direction.normalize();
  // The default of up must not be parallel to the direction.
  entry.up = std::abs(entry.direction.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  fields.vector3("up", entry.up, quantities::kDirection);
  if (entry.up.cross(entry.direction).norm() < 1e-6 * entry.up.norm() || entry.up.norm() < 1e-9)
    fields.reject("up", "must not be parallel to direction; give a direction across the wire");
}

}  // namespace

void visitRotation(yaml::Fields& fields, Eigen::Isometry3d& transform)
{
  if (fields.has("head") || fields.has("left"))
  {
    if (fields.has("rotation"))
      fields.reject("rotation", "conflicts with head and left; keep one of the two");
    transform.linear() = rotationFromBody(fields);
    return;
  }
  std::vector<std::vector<double>> rows(3);
  for (int i = 0; i < 3; ++i)
    rows[static_cast<std::size_t>(i)] = {transform(i, 0), transform(i, 1), transform(i, 2)};
  fields.rows("rotation", rows,
              {quantities::kRotationMatrix, quantities::kRotationMatrix, quantities::kRotationMatrix});
  if (!fields.reading())
    return;
  if (rows.size() != 3)
    fields.reject("rotation", "expected three rows of three numbers, e.g. [[1, 0, 0], [0, 1, 0], [0, 0, 1]]");
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      transform(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  const Eigen::Matrix3d& r = transform.linear();
  if (!(r * r.transpose()).isIdentity(1e-6) || r.determinant() < 0.0)
    fields.reject("rotation", "is not a rotation; rows must be right-handed, unit vectors at right angles");
}

void visitVessel(yaml::Fields& fields, VesselScene& vessel)
{
  const bool reading = fields.reading();
  const bool is_mesh = reading ? fields.has("mesh") : !vessel.mesh.empty();
  const bool is_anatomy = reading ? fields.has("anatomy") : !vessel.anatomy.empty();
  const bool is_tube = reading ? fields.has("tube") : vessel.tube.has_value();
  if (int{is_mesh} + int{is_anatomy} + int{is_tube} != 1)
    fields.reject(is_mesh || is_anatomy ? "mesh" : "",
                  "needs exactly one of mesh, anatomy, tube; e.g. --set vessel.mesh=/path/vessel.stl "
                  "--set vessel.anatomy=null, or vessel: none");
  if (is_mesh)
    visitMesh(fields, vessel);
  else if (reading)
    rejectMeshKeys(fields);
  if (is_anatomy)
    fields.text("anatomy", vessel.anatomy);
  if (is_tube)
  {
    if (!vessel.tube)
      vessel.tube = vessel::TubeShape{};
    fields.map("tube", [&vessel](yaml::Fields& tube) { visitTube(tube, *vessel.tube); });
  }
  fields.integer("smoothing", vessel.smoothing, 0, 3);
  if (fields.reading() || vessel.wall != contact::WallShape::kFacets)
    fields.option("wall", vessel.wall, kWallShapes);
  fields.number("stiffness", vessel.stiffness, quantities::kWallStiffness,
                {0.0, std::numeric_limits<double>::max(), true, true});
  visitFriction(fields, vessel.friction, Need::kRequired);
  visitFrictionRegions(fields, vessel);
  visitLesions(fields, vessel);
}

void visitFriction(yaml::Fields& fields, double& friction, Need need)
{
  if (fields.reading() && fields.hasWord("friction"))
  {
    int surface = 0;
    fields.choice("friction", surface, kSurfaces, need);
    friction = kSurfaceFriction[static_cast<std::size_t>(surface)];
  }
  else if (need == Need::kRequired)
    fields.number("friction", friction, quantities::kFriction, Range::nonNegative(), need);
  else
    fields.optionalNumber("friction", friction, quantities::kFriction, Range::nonNegative());
}

void visitEntry(yaml::Fields& fields, EntryScene& entry, const std::optional<VesselScene>& vessel)
{
  const bool real_vessel = vessel && !vessel->tube;
  fields.text("centreline_end", entry.centreline_end);
  fields.boolean("nearest_centreline_end", entry.nearest_centreline_end);
  const bool at_end = entry.nearest_centreline_end || !entry.centreline_end.empty();
  if (fields.reading() && entry.nearest_centreline_end && !entry.centreline_end.empty())
    fields.reject("centreline_end", "conflicts with nearest_centreline_end; keep one of the two");
  if (fields.reading() && at_end && !real_vessel)
    fields.reject(entry.nearest_centreline_end ? "nearest_centreline_end" : "centreline_end",
                  "needs a vessel with a centreline (vessel.mesh or vessel.anatomy); give position and direction");
  if (fields.reading() && real_vessel && !at_end && (!fields.has("position") || !fields.has("direction")))
    fields.reject(fields.has("position") ? "direction" : "position",
                  "missing; give position and direction, or nearest_centreline_end: true, or centreline_end");
  const bool needs_point = real_vessel && entry.nearest_centreline_end;
  fields.vector3("position", entry.position, needs_point ? kSelectingPoint : quantities::kPosition,
                 needs_point ? Need::kRequired : Need::kOptional);
  if (fields.reading())
    readDirection(fields, entry);
  else
  {
    fields.vector3("direction", entry.direction, quantities::kDirection);
    fields.vector3("up", entry.up, quantities::kDirection);
  }
  fields.number("offset", entry.offset, quantities::kVesselLength, Range::nonNegative());
  if (fields.reading() && entry.offset != 0.0 && !at_end)
    fields.reject("offset", "applies to a centreline end only; move position instead");
  fields.number("valve_friction", entry.valve_friction, quantities::kValveFriction, Range::nonNegative());
}

}  // namespace endovascular_sim::scene
