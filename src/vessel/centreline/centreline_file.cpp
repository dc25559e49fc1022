#include "vessel/centreline/centreline_file.h"

#include <fstream>

#include "common/output_file.h"
#include "yaml/writer.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Arc length at each point as a fraction of the branch's length. */
std::vector<double> fractions(const CentrelineBranch& branch)
{
  std::vector<double> arc{0.0};
  for (std::size_t k = 1; k < branch.points.size(); ++k)
    arc.push_back(arc.back() + (branch.points[k] - branch.points[k - 1]).norm());
  for (double& s : arc)
    s /= arc.back();
  return arc;
}

}  // namespace

void writeCentreline(const CentrelineTree& tree, const std::string& name, const std::string& path)
{
  std::ofstream out(path);
  out.precision(9);
  out << "# Centreline of a vessel mesh: points and inscribed diameters, in metres.\n"
      << "name: " << yaml::quoted(name) << "\nunit: 1\nbranches:\n";
  for (const CentrelineBranch& branch : tree.branches)
  {
    out << "  - name: " << yaml::quoted(branch.name) << "\n";
    if (branch.parent >= 0)
      out << "    parent: " << yaml::quoted(tree.branches[static_cast<std::size_t>(branch.parent)].name) << "\n";
    out << "    points:\n";
    for (const Eigen::Vector3d& p : branch.points)
      out << "      - [" << p.x() << ", " << p.y() << ", " << p.z() << "]\n";
    out << "    diameters:\n";
    const std::vector<double> at = fractions(branch);
    for (std::size_t k = 0; k < at.size(); ++k)
      out << "      - [" << at[k] << ", " << 2.0 * branch.radii[k] << "]\n";
  }
  out.close();
  if (!out)
    throw writeError(path);
}

}  // namespace endovascular_sim::vessel
