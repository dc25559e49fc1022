#include "contact/wall_features.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kSameNormal = 0.9995;  // cosine between normals above which two features of a node are one

}  // namespace

void appendDistinct(std::vector<Feature>& features, std::size_t first, const Feature& feature)
{
  for (std::size_t f = first; f < features.size(); ++f)
    if (features[f].id == feature.id || features[f].normal.dot(feature.normal) > kSameNormal)
    {
      if (feature.gap < features[f].gap)
        features[f] = feature;
      return;
    }
  features.push_back(feature);
}

}  // namespace endovascular_sim::contact
