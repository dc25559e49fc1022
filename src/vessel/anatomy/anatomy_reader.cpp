#include <algorithm>
#include <iterator>

#include "common/hash.h"
#include "common/input_file.h"
#include "common/quantities.h"
#include "vessel/anatomy/anatomy.h"
#include "yaml/reader.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Path of an item of a list. */
std::string itemOf(const std::string& key, std::size_t k)
{
  return key + "." + std::to_string(k);
}

/** Positive length in the unit of the file.
 *  @param unit unit of the file [m]
 *  @return length [m] */
double readLength(yaml::Fields& fields, const std::string& key, double unit, const Quantity& quantity)
{
  double value = 0.0;
  fields.number(key, value, quantities::kNumber, yaml::Range::positive(), yaml::Need::kRequired);
  fields.judge(key, quantity, unit * value);
  return unit * value;
}

/** Position in the unit of the file.
 *  @param key key of the position, or its path below a list
 *  @return position [m] */
Eigen::Vector3d inMetres(const yaml::Fields& fields, const std::string& key, double unit, const Eigen::Vector3d& value)
{
  const Eigen::Vector3d metres = unit * value;
  fields.judge(key, quantities::kPosition, metres.cwiseAbs().maxCoeff());
  return metres;
}

void readPoints(yaml::Fields& fields, double unit, AnatomyBranch& branch)
{
  std::vector<std::vector<double>> rows;
  fields.rows("points", rows, {3, quantities::kNumber}, yaml::Need::kRequired);
  for (std::size_t k = 0; k < rows.size(); ++k)
    branch.points.push_back(
        inMetres(fields, itemOf("points", k), unit, Eigen::Map<const Eigen::Vector3d>(rows[k].data())));
  if (branch.points.size() < (branch.continues ? 1U : 2U))
    fields.reject("points", "too few; a branch needs two points (one when it continues another)");
  for (std::size_t k = 1; k < branch.points.size(); ++k)
    if ((branch.points[k] - branch.points[k - 1]).norm() < 1e-5)
      fields.reject(itemOf("points", k), "points " + std::to_string(k) + " and " + std::to_string(k + 1) + " coincide");
}

/** List of [fraction of the branch's length, diameter]. */
void readDiameters(yaml::Fields& fields, double unit, AnatomyBranch& branch)
{
  std::vector<std::vector<double>> rows;
  fields.rows("diameters", rows, {2, quantities::kNumber}, yaml::Need::kRequired);
  if (rows.empty())
    fields.reject("diameters", "needs at least one [fraction, diameter]");
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    const std::string key = itemOf("diameters", k);
    if (!(rows[k][0] >= 0.0 && rows[k][0] <= 1.0))
      fields.reject(key, "the first number must be a fraction from 0 to 1 of the branch's length");
    if (!(rows[k][1] > 0.0))
      fields.reject(key, "the second number must be a positive diameter");
    if (k > 0 && !(rows[k][0] > rows[k - 1][0]))
      fields.reject(key, "the fractions must increase from one entry to the next");
    branch.diameters.emplace_back(rows[k][0], unit * rows[k][1]);
    fields.judge(key, quantities::kVesselDiameter, branch.diameters.back().second);
  }
}

Stenosis readStenosis(yaml::Fields& fields, double unit)
{
  std::string name;
  fields.text("name", name);
  Stenosis stenosis;
  fields.number("position", stenosis.position, quantities::kNumber, yaml::Range::between(0.0, 1.0),
                yaml::Need::kRequired);
  stenosis.length = readLength(fields, "length", unit, quantities::kLesionLength);
  // An occlusion has no lumen.
  fields.number("reduction", stenosis.reduction, quantities::kNumber, yaml::Range::between(0.0, 0.95),
                yaml::Need::kRequired);
  return stenosis;
}

/** Index of the branch that a key names. @param otherwise remedy where there is none */
int indexOf(const Anatomy& anatomy, yaml::Fields& fields, const std::string& key, const std::string& otherwise)
{
  std::string name;
  fields.text(key, name, yaml::Need::kRequired);
  const auto found = std::find_if(anatomy.branches.begin(), anatomy.branches.end(),
                                  [&name](const AnatomyBranch& branch) { return branch.name == name; });
  if (found == anatomy.branches.end())
    fields.reject(key, "no earlier branch \"" + name + "\"; " + otherwise);
  return static_cast<int>(found - anatomy.branches.begin());
}

void readFacets(yaml::Fields& fields, int& facets_around)
{
  fields.integer("facets_around", facets_around, 8, 64);
}

void readBlend(yaml::Fields& fields, double& blend)
{
  fields.number("blend", blend, quantities::kNumber, yaml::Range::between(0.05, 3.0));
}

/** Keys `parent` and `continues`. */
void readParent(yaml::Fields& fields, const Anatomy& anatomy, AnatomyBranch& branch)
{
  const bool has_parent = fields.has("parent");
  branch.continues = fields.has("continues");
  if (branch.continues && has_parent)
    fields.reject("continues", "excludes parent; keep one of the two");
  if (branch.continues || has_parent)
    branch.parent =
        indexOf(anatomy, fields, branch.continues ? "continues" : "parent", "a parent must precede its children");
  else if (!anatomy.branches.empty())
    fields.reject("parent", "missing; only the first branch has no parent");
  for (const AnatomyBranch& other : anatomy.branches)
    if (branch.continues && other.continues && other.parent == branch.parent)
      fields.reject("continues", "\"" + other.name + "\" already continues that branch; use parent");
}

AnatomyBranch readBranch(yaml::Fields& fields, double unit, const Anatomy& anatomy)
{
  AnatomyBranch branch;
  fields.text("name", branch.name, yaml::Need::kRequired);
  for (const AnatomyBranch& other : anatomy.branches)
    if (other.name == branch.name)
      fields.reject("name", "is the name of an earlier branch; names must be unique");
  readParent(fields, anatomy, branch);
  readPoints(fields, unit, branch);
  readDiameters(fields, unit, branch);
  fields.list(
      "stenoses", 0, [](std::size_t) {},
      [&](yaml::Fields& stenosis, std::size_t) { branch.stenoses.push_back(readStenosis(stenosis, unit)); });
  if (branch.continues && fields.has("facets_around"))
    fields.reject("facets_around", "belongs to the branch that this one continues; remove it here");
  readFacets(fields, branch.facets_around);
  return branch;
}

Bulge readBulge(yaml::Fields& fields, double unit, double blend)
{
  Bulge bulge;
  bulge.blend = blend;
  fields.text("name", bulge.name, yaml::Need::kRequired);
  fields.vector3("centre", bulge.centre, quantities::kNumber, yaml::Need::kRequired);
  bulge.centre = inMetres(fields, "centre", unit, bulge.centre);
  bulge.radius = readLength(fields, "radius", unit, quantities::kVesselRadius);
  readBlend(fields, bulge.blend);
  return bulge;
}

Landmark readLandmark(yaml::Fields& fields, const Anatomy& anatomy)
{
  Landmark landmark;
  fields.text("name", landmark.name, yaml::Need::kRequired);
  landmark.origin = indexOf(anatomy, fields, "origin", "name one of branches");
  landmark.branch = indexOf(anatomy, fields, "branch", "name one of branches");
  fields.number("position", landmark.position, quantities::kNumber, yaml::Range::between(0.0, 1.0),
                yaml::Need::kRequired);
  return landmark;
}

void readAnatomy(yaml::Fields& fields, Anatomy& anatomy)
{
  fields.text("name", anatomy.name, yaml::Need::kRequired);
  double unit = 1.0;
  fields.number("unit", unit, quantities::kMeshUnit, yaml::Range::between(1e-6, 1.0), yaml::Need::kRequired);
  readBlend(fields, anatomy.blend);
  readFacets(fields, anatomy.facets_around);
  if (fields.has("longest_facet"))
    anatomy.longest_facet = readLength(fields, "longest_facet", unit, quantities::kFacetLength);
  const auto ignore_size = [](std::size_t) {};
  fields.list(
      "branches", 0, ignore_size,
      [&](yaml::Fields& branch, std::size_t) { anatomy.branches.push_back(readBranch(branch, unit, anatomy)); },
      yaml::Need::kRequired);
  fields.list("bulges", 0, ignore_size,
              [&](yaml::Fields& bulge, std::size_t)
              { anatomy.bulges.push_back(readBulge(bulge, unit, anatomy.blend)); });
  fields.list("landmarks", 0, ignore_size,
              [&](yaml::Fields& landmark, std::size_t)
              { anatomy.landmarks.push_back(readLandmark(landmark, anatomy)); });
}

}  // namespace

Anatomy readAnatomy(const std::string& file)
{
  std::ifstream in = openInputFile(file, "give an anatomy as in config/anatomies/natural.yaml", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  Anatomy anatomy;
  anatomy.file = file;
  Hash64 hash;
  hash.add(text);
  anatomy.content_hash = hash.value();
  const yaml::Node root = yaml::parseTree(text, file);
  yaml::ReadingReport report;
  yaml::Reader reader(root, &report, yaml::ItemLabel::kName);
  readAnatomy(reader, anatomy);
  reader.finish();
  anatomy.warnings = report.warnings;
  return anatomy;
}

}  // namespace endovascular_sim::vessel
