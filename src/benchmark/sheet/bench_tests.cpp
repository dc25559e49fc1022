#include "benchmark/sheet/bench_tests.h"

#include "common/error.h"

namespace endovascular_sim::benchmark
{

double SheetRow::deviation() const
{
  return by_difference ? value - reference : value / reference - 1.0;
}

std::vector<BenchTest> benchTests(const instrument::Instrument& instrument, const SpecimenChoice& choice)
{
  if (instrument.wire.sections.empty())
    throw InputError(instrument.name, "kind", "a stent has no shaft to test; give a guidewire or a catheter");
  std::vector<BenchTest> tests = {threePointTest(instrument, choice), torqueTest(instrument, choice)};
  if (instrument.kind == instrument::Kind::kGuidewire)
  {
    tests.push_back(tipFlexibilityTest(instrument));
    tests.push_back(tipLoadTest(instrument));
  }
  tests.push_back(pushabilityTest(instrument, choice));
  tests.push_back(trackabilityTest(instrument, choice));
  return tests;
}

}  // namespace endovascular_sim::benchmark
