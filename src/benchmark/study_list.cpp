#include "benchmark/study_list.h"

#include "benchmark/coaxial/coaxial_study.h"
#include "benchmark/coaxial/jam_study.h"
#include "benchmark/facets/facets_study.h"
#include "benchmark/force_quality/force_quality_study.h"
#include "benchmark/mouth/mouth_study.h"
#include "benchmark/reversal/reversal_study.h"
#include "benchmark/sleeve/sleeve_study.h"
#include "benchmark/studies/accuracy.h"
#include "benchmark/studies/contact_study.h"
#include "benchmark/studies/hand_force_study.h"
#include "benchmark/studies/sampling_sections.h"
#include "benchmark/studies/speed.h"
#include "benchmark/studies/stability.h"
#include "benchmark/studies/work_precision.h"
#include "benchmark/x_ray/x_ray_study.h"

namespace endovascular_sim::benchmark
{

const std::vector<Study>& studies()
{
  static const std::vector<Study> list = {
      {"accuracy", "Accuracy", "errors against reference values with the observed order", accuracyTables(),
       accuracyStudy},
      {"work-precision", "Work and precision", "error over run time", workPrecisionTables(), workPrecisionStudy},
      {"speed", "Speed", "time per step by phase over the number of nodes", speedTables(), speedStudy},
      {"coaxial", "Friction between layers", "hand force in a catheter against a rigid tube", coaxialTables(),
       coaxialStudy},
      {"jam", "Jammed wire", "hand force of a wire that jams in a catheter against a rigid tube", jamTables(),
       jamStudy},
      {"contact", "Contact", "detection: bounding volumes, time per step, growth with the triangles", contactTables(),
       contactStudy},
      {"hand_force", "Force at the hand", "curves, nodes, noise", handForceTables(), handForceStudy},
      {"reversal", "Torque after a reversal", "torque at the hand over the speed and the time step", reversalTables(),
       reversalStudy},
      {"facets", "Facets around the lumen", "torque of a J tip over the facets, facetted and smooth wall",
       facetsTables(), facetsStudy},
      {"mouth", "Introducer's mouth", "force at the hand of curved instruments against quasi-static equilibria",
       mouthTables(), mouthStudy},
      {"force_quality", "Quality of the force", "changes per millisecond and noise in every shipped scene",
       forceQualityTables(), forceQualityStudy},
      {"sleeve", "Rod through a sleeve", "force at the hand against the exact elastica", sleeveTables(), sleeveStudy},
      {"x_ray", "X-ray frames", "processor time over pixels and triangles, at rest and after a movement", xRayTables(),
       xRayStudy},
      {"sampling", "Adaptive sampling", "adaptive against uniform sampling", samplingTables(), samplingSections},
      {"stability", "Stability", "hard cases: good, rejected or bad", stabilityTables(), stabilityStudy}};
  return list;
}

}  // namespace endovascular_sim::benchmark
