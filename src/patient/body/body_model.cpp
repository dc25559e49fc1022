#include "patient/body/body_model.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "common/error.h"
#include "common/file/binary_file.h"
#include "common/hash.h"
#include "common/text/format.h"
#include "patient/body/anatomy_parts.h"
#include "patient/body/body_placement.h"
#include "patient/volume/lumen_mask.h"

namespace endovascular_sim::patient
{
namespace
{

const Eigen::Vector3f kLow(-196.0F, -126.0F, -345.0F);  // corners of the volume in the body's frame [mm]
const Eigen::Vector3f kHigh(196.0F, 140.0F, 450.0F);

void check(const BodySettings& settings)
{
  if (!(settings.spacing >= 0.5e-3 && settings.spacing <= 10e-3))
    throw InputError("patient.body", "spacing", "must lie between 0.0005 and 0.01 [m]");
}

image::VolumeGrid gridFor(const BodyFrame& frame, double spacing)
{
  image::VolumeGrid grid;
  grid.spacing.setConstant(spacing);
  grid.origin = frame.toPatient(kLow);
  const Eigen::Vector3d size = (frame.toPatient(kHigh) - grid.origin) / spacing;
  grid.size = size.array().ceil().cast<int>() + 1;
  return grid;
}

/** All parts; where they overlap, later soft tissue replaces earlier one. */
BodyPlan planFor(const SpineCurve& spine, std::uint64_t seed)
{
  BodyPlan plan;
  addTorso(plan);
  addAbdomen(plan, spine, seed);
  addLungs(plan, seed);
  addHeart(plan);
  addVertebrae(plan, spine);
  addRibCage(plan, spine);
  addShoulderGirdle(plan);
  addPelvis(plan);
  addFemurs(plan);
  return plan;
}

/** Fills the lumen with blood, surrounds it with one voxel of wall, and removes bone within two voxels. */
void placeVessel(DensityVolume& volume, const geometry::TriangleMesh& mesh)
{
  const image::VolumeGrid& grid = volume.grid();
  const VoxelMask lumen = lumenMask(grid, mesh);
  const VoxelMask wall = dilated(grid, lumen, 1), surroundings = dilated(grid, lumen, 2);
  const std::uint16_t blood = DensityVolume::encode({propertiesOf(Tissue::kBlood).density, 0.0});
  for (std::size_t i = 0; i < surroundings.size(); ++i)
  {
    std::uint16_t& voxel = volume.voxels()[i];
    if (lumen[i] != 0 || wall[i] != 0 || (surroundings[i] != 0 && (voxel >> 8) != 0))
      voxel = blood;
  }
}

std::uint64_t keyOf(const vessel::Vessel& vessel, const BodyFrame& frame, const BodySettings& settings)
{
  Hash64 key;
  key.add(static_cast<std::uint64_t>(kBodyVersion));
  key.add(vessel.mesh.hash());
  key.add(frame.origin.x());
  key.add(frame.origin.y());
  key.add(frame.origin.z());
  key.add(frame.scale);
  key.add(settings.spacing);
  key.add(settings.seed);
  return key.value();
}

}  // namespace

BodyMap bodyMap(const BodyFrame& frame, const std::vector<Eigen::Vector3d>& wall, std::uint64_t seed)
{
  std::vector<Point> points;
  for (const Eigen::Vector3d& point : wall)
    points.push_back(frame.fromPatient(point));
  const SpineCurve spine(points);
  return {frame, planFor(spine, seed), seed, 1e-3 * frame.scale * static_cast<double>(spine.displacement())};
}

PatientVolume makeBody(const vessel::Vessel& vessel, const BodySettings& settings)
{
  check(settings);
  const BodyPlacement placement = placeBody(vessel);
  auto volume = std::make_shared<DensityVolume>(gridFor(placement.frame, settings.spacing), "patient.body");
  const BodyMap map = bodyMap(placement.frame, vessel.mesh.vertices, settings.seed);
  voxelise(map.parts, map.frame, map.seed, *volume);
  placeVessel(*volume, vessel.mesh);
  PatientVolume body{std::move(volume), {placement.note}};
  if (map.spine_displacement > 0.0)
    body.notes.push_back(formatted("spine moved back by up to %.0f mm for the vessel", 1e3 * map.spine_displacement));
  return body;
}

PatientVolume loadBody(const vessel::Vessel& vessel, const BodySettings& settings, const std::string& cache_folder)
{
  check(settings);
  if (cache_folder.empty())
    return makeBody(vessel, settings);
  const BodyPlacement placement = placeBody(vessel);
  const std::uint64_t key = keyOf(vessel, placement.frame, settings);
  const std::string entry = cache_folder + "/body_" + Hash64::toHex(key) + ".voxels";
  const std::optional<std::string> cached = readCacheFile(entry, key);
  auto volume = std::make_shared<DensityVolume>(gridFor(placement.frame, settings.spacing), "patient.body");
  if (cached && cached->size() == volume->memory())
  {
    std::memcpy(volume->voxels().data(), cached->data(), cached->size());
    return {std::move(volume), {placement.note, "body loaded from " + entry}};
  }
  PatientVolume body = makeBody(vessel, settings);
  try
  {
    writeCacheFile(entry, key, {bytesOf(body.volume->voxels())});
  }
  catch (const InputError& error)
  {
    body.notes.push_back(std::string("the body is not cached and will be made again by the next run: ") + error.what());
  }
  return body;
}

}  // namespace endovascular_sim::patient
