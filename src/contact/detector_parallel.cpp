#include <algorithm>

#include "contact/detector.h"

// A long search, shared with another thread.

namespace endovascular_sim::contact
{
namespace
{

constexpr std::size_t kLongSearch = 4000;  // entries to look at from which on another thread is woken
constexpr std::size_t kParts = 16;         // into which such a search is cut

}  // namespace

/** Makes parts that each have about as much to look at, by the last lists.
 *  @return false where the search is too short to wake a thread */
bool Detector::cutIntoParts(const Query& query)
{
  const auto entries = [this, &query](std::size_t index)
  {
    const NeighbourList& near = neighbourhood(query, index);
    return near.triangles.size() + near.edges.size();
  };
  const std::size_t n = query.nodes.size();
  std::size_t all = 0;
  for (std::size_t i = 0; i < n; ++i)
    all += entries(i);
  if (all < kLongSearch)
    return false;
  parts_.resize(kParts);
  std::size_t node = 0;
  std::size_t before = 0;
  for (std::size_t p = 0; p < kParts; ++p)
  {
    parts_[p].begin = node;
    while (node < n && (p + 1 == kParts || before * kParts < all * (p + 1)))
      before += entries(node++);
    parts_[p].end = node;
  }
  return true;
}

/** As one thread finds them: what the nodes meet, then what the edges do. */
void Detector::detectParts(const Query& query, std::vector<Feature>& features)
{
  const std::size_t edges = query.nodes.size() - 1;
  helper_->run(kParts,
               [this, &query, edges](std::uint32_t p)
               {
                 Part& part = parts_[p];
                 part.of_nodes.clear();
                 part.of_edges.clear();
                 for (std::size_t i = part.begin; i < part.end; ++i)
                   renewList(query, i, part.collected);
                 for (std::size_t i = part.begin; i < part.end; ++i)
                   detectNode(query, i, part.of_nodes);
                 for (std::size_t i = part.begin; i < std::min(part.end, edges); ++i)
                   detectEdge(query, i, part.of_edges);
                 addLaw(query, part.of_nodes);
                 addLaw(query, part.of_edges);
               });
  for (const Part& part : parts_)
    features.insert(features.end(), part.of_nodes.begin(), part.of_nodes.end());
  for (const Part& part : parts_)
    features.insert(features.end(), part.of_edges.begin(), part.of_edges.end());
}

}  // namespace endovascular_sim::contact
