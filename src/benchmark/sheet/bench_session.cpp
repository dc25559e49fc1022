#include "benchmark/sheet/bench_session.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/text/format.h"
#include "scene/file_search.h"
#include "scene/scene_file.h"

namespace endovascular_sim::benchmark
{
namespace
{

std::string pathOf(const std::string& name)
{
  return scene::configFolder() + "/scenes/" + name + ".yaml";
}

}  // namespace

scene::Scene benchScene(const std::string& name)
{
  return scene::loadScene(pathOf(name));
}

BenchSession::BenchSession(const std::string& name, const std::vector<std::string>& overrides)
  : session_(session::World::open(pathOf(name), overrides))
{
}

void BenchSession::runTo(double time)
{
  const double step = scene().solver.time_step;
  session_.step(static_cast<int>(std::max(0.0, std::round((time - this->time()) / step))));
}

std::string setting(const std::string& key, double value)
{
  return key + formatted("=%.17g", value);
}

std::string setting(const std::string& key, const Eigen::Vector3d& value)
{
  return key + formatted("=[%.17g, %.17g, %.17g]", value.x(), value.y(), value.z());
}

double sharpestCurvature(const vessel::TubeShape& tube)
{
  double sharpest = 0.0;
  for (const vessel::TubePiece& piece : tube.pieces)
    sharpest = std::max(sharpest, piece.curvature);
  return sharpest;
}

double totalTurn(const vessel::TubeShape& tube)
{
  double turn = 0.0;
  for (const vessel::TubePiece& piece : tube.pieces)
    turn += piece.length * piece.curvature;
  return turn;
}

double meanRadius(const vessel::TubeShape& tube)
{
  return 0.5 * tube.radius * (1.0 + std::cos(M_PI / tube.facets_around));
}

double meanOf(const std::vector<double>& values)
{
  return values.empty() ? 0.0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace endovascular_sim::benchmark
