#pragma once

#include <limits>
#include <string>
#include <vector>

#include "instrument/instrument.h"
#include "results/svg_plot.h"

namespace endovascular_sim::benchmark
{

/** Result of a bench test: a line of the data sheet. */
struct SheetRow
{
  std::string quantity;
  double value = 0.0;
  std::string unit;
  double reference = std::numeric_limits<double>::quiet_NaN();  ///< expected value in the same unit; NaN: none
  std::string method;                                           ///< closed form or brute force that gives the reference
  bool by_difference = false;  ///< true: the deviation is the difference in the unit, for references near zero

  /** Value over reference less 1, or their difference; NaN without a reference. */
  double deviation() const;
};

/** Bench test of an instrument with its results. */
struct BenchTest
{
  std::string name;        ///< of the scene in config/scenes
  std::string heading;     ///< name of the test
  std::string conditions;  ///< specimen and set-up, in words
  std::vector<SheetRow> rows;
  std::vector<results::SvgPlot> plots;
};

/** Specimen of the tests. */
struct SpecimenChoice
{
  /** Distance of the shaft specimen's section from the tip; NaN: the middle of the longest section [m]. */
  double from_tip = std::numeric_limits<double>::quiet_NaN();
};

/** Three-point bending of a straight specimen on rollers: bending stiffness by 48 EI/L³ at a small deflection, and the
 *  force at L/10 against the exact elastica.
 *  @param overrides of the scene, after the specimen
 *  @throws InputError for a scene that is refused */
BenchTest threePointTest(const instrument::Instrument& instrument, const SpecimenChoice& choice,
                         const std::vector<std::string>& overrides = {});

/** Column force of the tip, and the force across it that moves it by 2 mm. */
BenchTest tipLoadTest(const instrument::Instrument& instrument);
BenchTest tipFlexibilityTest(const instrument::Instrument& instrument);

/** Proximal against distal turn of a shaft specimen in a bend. */
BenchTest torqueTest(const instrument::Instrument& instrument, const SpecimenChoice& choice);

/** Proximal against distal force of a shaft specimen that is pushed through two bends. */
BenchTest pushabilityTest(const instrument::Instrument& instrument, const SpecimenChoice& choice);

/** Force that advances a catheter over a guidewire through a bend, and withdraws it. The instrument is one of the two;
 *  the other one is of the library. */
BenchTest trackabilityTest(const instrument::Instrument& instrument, const SpecimenChoice& choice);

/** All tests that apply to an instrument.
 *  @throws InputError for a stent, which has no shaft */
std::vector<BenchTest> benchTests(const instrument::Instrument& instrument, const SpecimenChoice& choice);

}  // namespace endovascular_sim::benchmark
