#include "simulation/held_shaft.h"

#include "common/archive.h"
#include "common/archive_checks.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kCreep = 0.5e-3;  // largest speed of the place of a pressing balloon in the vessel [m/s]
constexpr int kPoints = 33;        // along a balloon, less than a millimetre apart

}  // namespace

intervention::ShaftLine HeldShaft::follow(const intervention::ShaftLine& shaft, double begin, double end,
                                          double time_step)
{
  std::vector<double> from_tip;
  for (int k = 0; k < kPoints; ++k)
    from_tip.push_back(begin + (end - begin) * k / (kPoints - 1));
  if (points_.empty())
    for (const double distance : from_tip)
      points_.push_back(shaft.at(distance));
  for (std::size_t k = 0; k < points_.size(); ++k)
  {
    const Eigen::Vector3d way = shaft.at(from_tip[k]) - points_[k];
    const double most = kCreep * time_step, length = way.norm();
    points_[k] += length > most ? Eigen::Vector3d(most / length * way) : way;
  }
  return {from_tip, points_};
}

void HeldShaft::archive(Archive& archive)
{
  archive(points_);
  if (!archive.reading())
    return;
  requireLoaded(points_.empty() || points_.size() == kPoints, "holds a balloon of another length");
  requireFinite(points_);
}

}  // namespace endovascular_sim::simulation
