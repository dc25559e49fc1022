#include "segmentation/branch_verdict.h"

#include <algorithm>
#include <cmath>

#include "common/text/format.h"
#include "segmentation/lumen/open_stretch.h"
#include "segmentation/other_lumens.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Reasons, with the most severe use. */
class Judgement
{
public:
  void add(Use use, const std::string& reason)
  {
    verdict.use = std::max(verdict.use, use);
    verdict.reasons.push_back(reason);
  }

  BranchVerdict verdict;
};

/** Stretches by the arc length, e.g. "12 to 15 mm, 40 to 41 mm". */
std::string placesOf(const std::vector<Stretch>& stretches)
{
  std::string text;
  for (const Stretch& stretch : stretches)
    text += (text.empty() ? "" : ", ") + formatted("%.0f to %.0f mm", 1e3 * stretch.from, 1e3 * stretch.to);
  return text;
}

void judgeEdges(const LumenBranch& branch, const OtherLumen& other, Judgement& judgement)
{
  const std::vector<double> arc = branch.arc();
  const auto places = [&](double share)
  {
    std::vector<Stretch> found;
    for (const OpenStretch& open : openStretches(branch.sections, other, true, share))
      found.push_back({arc[open.first], arc[open.last]});
    return found;
  };
  if (const std::vector<Stretch> unknown = places(kUnknownShare); !unknown.empty())
    judgement.add(Use::kDoNotUse,
                  formatted("no edge along more than %.0f %% of the circumference at ", 100.0 * kUnknownShare) +
                      placesOf(unknown));
  else if (const std::vector<Stretch> doubtful = places(kDoubtfulShare); !doubtful.empty())
    judgement.add(Use::kLook,
                  formatted("no edge along more than %.0f %% of the circumference at ", 100.0 * kDoubtfulShare) +
                      placesOf(doubtful));
}

void judgeCalcium(const LumenBranch& branch, Judgement& judgement)
{
  const std::vector<double> arc = branch.arc();
  std::vector<Stretch> found;
  bool is_open = false;
  for (std::size_t k = 0; k < arc.size(); ++k)
  {
    double sum = 0.0;
    int count = 0;
    for (std::size_t q = 0; q < arc.size(); ++q)
      if (std::abs(arc[q] - arc[k]) <= 0.5 * kOpenLength)
      {
        sum += branch.sections[q].share(RayEnd::kCalcium);
        ++count;
      }
    const bool is_calcified = sum > kCalciumShare * count;
    if (is_calcified && !is_open)
      found.push_back({arc[k], arc[k]});
    else if (is_calcified)
      found.back().to = arc[k];
    is_open = is_calcified;
  }
  if (!found.empty())
    judgement.add(Use::kLook, "calcium at " + placesOf(found));
}

std::string textOf(const Throat& throat)
{
  return formatted("throat of %.2f ± %.2f mm at %.0f mm, %.1f voxels wide", 1e3 * throat.diameter, 1e3 * throat.error,
                   1e3 * throat.at, throat.voxels);
}

void judgeThroat(const Throat& throat, Judgement& judgement)
{
  if (throat.voxels < kLostVoxels)
    judgement.add(Use::kDoNotUse, textOf(throat));
  else if (throat.voxels < kThroatVoxels)
    judgement.add(Use::kLook, textOf(throat));
}

}  // namespace

double throatError(double diameter, double blur)
{
  return blur * (0.3 + 1.4 * std::exp(-0.5 * diameter / blur));
}

Throat throatOf(const Scan& scan, const LumenBranch& branch)
{
  const std::vector<double> arc = branch.arc();
  std::size_t narrowest = 0;
  for (std::size_t k = 1; k < arc.size(); ++k)
    if (branch.sections[k].diameter() < branch.sections[narrowest].diameter())
      narrowest = k;
  const Section& section = branch.sections[narrowest];
  Throat throat;
  throat.diameter = section.diameter();
  throat.at = arc[narrowest];
  throat.position = scan.toPatient(section.centre);
  throat.voxels = throat.diameter / std::cbrt(scan.spacing().prod());
  throat.error = throatError(throat.diameter, section.blur);
  return throat;
}

std::vector<std::string> throatWarnings(const Scan& scan, const std::vector<LumenBranch>& branches)
{
  std::vector<std::string> warnings;
  for (const LumenBranch& branch : branches)
    if (const Throat throat = throatOf(scan, branch); throat.voxels < kThroatVoxels)
      warnings.push_back(branch.name + ": " + textOf(throat) +
                         "; reconstruct smaller voxels with a sharper kernel, or measure it in another image");
  return warnings;
}

std::string nameOf(Use use)
{
  return use == Use::kUse ? "use" : use == Use::kLook ? "look" : "do not use";
}

BranchVerdict verdictOf(const Scan& scan, const std::vector<LumenBranch>& branches, std::size_t branch,
                        const std::vector<std::string>& warnings)
{
  const LumenBranch& own = branches[branch];
  Judgement judgement;
  judgeEdges(own, otherLumens(branches, branch), judgement);
  judgeThroat(throatOf(scan, own), judgement);
  judgeCalcium(own, judgement);
  if (const std::vector<Stretch> turns = turnsOf(own); !turns.empty())
    judgement.add(Use::kLook, "the path turns at " + placesOf(turns));
  const std::string begin = own.name + ": ";
  for (const std::string& warning : warnings)
  {
    if (warning.compare(0, begin.size(), begin) != 0)
      continue;
    const std::string reason = warning.substr(begin.size(), warning.find(';') - begin.size());
    const std::vector<std::string>& known = judgement.verdict.reasons;
    if (std::find(known.begin(), known.end(), reason) == known.end())
      judgement.add(Use::kLook, reason);
  }
  return judgement.verdict;
}

}  // namespace endovascular_sim::segmentation
