#include "rod/contact/node_renumbering.h"

#include <algorithm>

#include "common/archive.h"

namespace endovascular_sim::rod
{

void NodeRange::add(const NodeRange& other)
{
  if (other.empty())
    return;
  begin = empty() ? other.begin : std::min(begin, other.begin);
  end = std::max(end, other.end);
}

void NodeRange::archive(Archive& archive)
{
  archive(begin, end);
}

NodeRenumbering::NodeRenumbering(const Discretisation& from, const Discretisation& to, int first_node)
  : shift_(to.nodes() - from.nodes()),
    is_shift_(first_node + shift_ >= 0 && std::equal(from.position.begin() + first_node, from.position.end(),
                                                     to.position.begin() + first_node + shift_, to.position.end()))
{
}

void NodeRenumbering::apply(std::vector<double>& of_nodes) const
{
  if (!is_shift_)
    of_nodes.clear();
  else if (shift_ > 0 && !of_nodes.empty())
    of_nodes.insert(of_nodes.begin(), static_cast<std::size_t>(shift_), of_nodes.front());
  else if (!of_nodes.empty())
    of_nodes.erase(of_nodes.begin(), of_nodes.begin() - shift_);
}

void NodeRenumbering::apply(NodeRange& range) const
{
  if (is_shift_ && !range.empty())
    range = {std::max(0, range.begin + shift_), range.end + shift_};
  else
    range = {};
}

}  // namespace endovascular_sim::rod
