#include "contact/detector.h"

#include <algorithm>
#include <utility>

#include "contact/facet_features.h"
#include "contact/smooth_features.h"

namespace endovascular_sim::contact
{
namespace
{

std::unique_ptr<WallFeatures> featuresOf(const WallModel& model)
{
  if (model.smooth() != nullptr)
    return std::make_unique<SmoothFeatures>();
  return std::make_unique<FacetFeatures>();
}

}  // namespace

Detector::Detector(std::shared_ptr<const WallModel> model, WallLaw law, std::uint64_t vessel_version)
  : model_(std::move(model)), law_(std::move(law)), vessel_version_(vessel_version), features_(featuresOf(*model_))
{
}

Detector::Detector(const geometry::TriangleMesh& mesh, WallLaw law, std::uint64_t vessel_version)
  : Detector(WallModel::create(mesh, law.shape), law, vessel_version)
{
}

void Detector::moveVertices(const std::vector<int>& indices, const std::vector<Eigen::Vector3d>& positions,
                            std::uint64_t vessel_version)
{
  vessel_version_ = vessel_version;
  if (indices.empty())
    return;
  lists_.followWall(WallModel::writable(model_).moveVertices(indices, positions));
}

/** Sets the common members of a contact set and updates the neighbour lists. */
void Detector::begin(const Query& query, ContactSet& set)
{
  set.step = query.step;
  set.substep = query.substep;
  set.pass = query.pass;
  set.vessel_version = vessel_version_;
  set.first_edge = query.first_node;
  set.features.clear();
  lists_.update(model_->bvh(), model_->bounds(), query, model_->deviation());
}

void Detector::detect(const Query& query, ContactSet& set)
{
  begin(query, set);
  const std::size_t n = query.nodes.size();
  set.free_distance.resize(n > 0 ? n - 1 : 0);
  for (std::size_t i = 0; i < set.free_distance.size(); ++i)
    set.free_distance[i] = std::min(query.margin[i], query.margin[i + 1]);
  features_->find(*model_, lists_, query, set.features);
  applyLaw(set.features);
}

void Detector::applyLaw(std::vector<Feature>& features) const
{
  for (Feature& feature : features)
  {
    feature.stiffness = law_.stiffness;
    feature.friction = law_.frictionAt(feature.point);
  }
}

/** Distance from a node to the wall, at most @p farthest; within the cutoff the distance to its possible contacts,
 *  which are listed already [m]. */
double Detector::wallDistance(const Query& query, std::size_t node, double farthest)
{
  const Eigen::Vector3d& point = query.nodes[node];
  const double cutoff = cutoffAt(query, node);
  const double listed = features_->distanceToListed(*model_, lists_.of(query, node), point, cutoff);
  if (listed <= cutoff)
    return listed;
  int& hint = nearest_[static_cast<std::size_t>(query.first_node) + node];
  const Bvh::Nearest found = model_->bvh().nearest(point, farthest + model_->deviation(), hint);
  hint = found.triangle >= 0 ? found.triangle : hint;
  return found.distance - model_->deviation();
}

void Detector::freeDistances(const Query& query, double wanted, ContactSet& set)
{
  begin(query, set);
  const std::size_t whole = static_cast<std::size_t>(query.first_node) + query.nodes.size();
  if (nearest_.size() < whole)
    nearest_.resize(whole, -1);
  // The distance to the wall is 1-Lipschitz, so both ends bound it along the edge: (d0 + d1 − |e|)/2.
  set.free_distance.resize(query.nodes.empty() ? 0 : query.nodes.size() - 1);
  // Search radius: an edge whose ends are both at least this far from the wall has the wanted free distance. Where one
  // end is closer, the other's distance may be underestimated: a larger search costs more than a shorter motion.
  double reach = 0.0;
  for (std::size_t i = 1; i < query.nodes.size(); ++i)
    reach = std::max(
        reach, 0.5 * (query.nodes[i] - query.nodes[i - 1]).norm() + std::max(query.radius[i - 1], query.radius[i]));
  const double farthest = wanted + reach;
  double previous = 0.0;
  for (std::size_t i = 0; i < query.nodes.size(); ++i)
  {
    const double distance = wallDistance(query, i, farthest);
    if (i > 0)
    {
      const double length = (query.nodes[i] - query.nodes[i - 1]).norm();
      const double radius = std::max(query.radius[i - 1], query.radius[i]);
      const double margin = std::min(query.margin[i - 1], query.margin[i]);
      set.free_distance[i - 1] = std::max(margin, 0.5 * (previous + distance - length) - radius);
    }
    previous = distance;
  }
}

}  // namespace endovascular_sim::contact
