#pragma once

#include <cmath>

#include "common/quantity.h"

/** Physical quantities of the keys of input files and of command-line options. Columns of the numbers: usual interval,
 *  accepted interval (Quantity). Zero as a lower bound: no lower bound. */
namespace endovascular_sim::quantities
{

using D = Dimension;

// Lengths of instruments.
constexpr Quantity kSectionLength{"section lengths", "m", D::kLength, 1e-4, 4.0, 1e-6, 10.0};
constexpr Quantity kWireRadius{"radii of instruments", "m", D::kRadius, 5e-5, 5e-3, 1e-6, 0.02};
constexpr Quantity kWireDiameter{"diameters of instruments", "m", D::kDiameter, 1e-4, 0.01, 2e-6, 0.04};
constexpr Quantity kBendRadius{"radii of curvature of tips", "m", D::kLength, 5e-4, 1.0, 1e-5, 10.0};
constexpr Quantity kTipLeg{"straight legs of tips", "m", D::kLength, 0.0, 0.2, 0.0, 5.0};
constexpr Quantity kFromTip{"distances from the tip", "m", D::kLength, 0.0, 2.0, 0.0, 10.0};
constexpr Quantity kMarkerLength{"marker lengths", "m", D::kLength, 1e-4, 0.05, 1e-6, 1.0};
constexpr Quantity kBalloonLength{"balloon lengths", "m", D::kLength, 2e-3, 0.3, 1e-5, 2.0};
constexpr Quantity kBalloonDiameter{"diameters of balloons and stents", "m", D::kDiameter, 3e-4, 0.05, 1e-5, 0.2};
constexpr Quantity kStentLength{"stent lengths", "m", D::kLength, 2e-3, 0.3, 1e-5, 2.0};
constexpr Quantity kStrutThickness{"strut thicknesses", "m", D::kLength, 2e-5, 5e-4, 1e-6, 5e-3};

// Lengths of vessels.
constexpr Quantity kMeshUnit{"mesh units", "m", D::kLength, 1e-6, 1.0, 1e-9, 10.0};
constexpr Quantity kPosition{"positions in the patient frame", "m", D::kLength, 0.0, 3.0, 0.0, 20.0};
constexpr Quantity kRegionRadius{"radii of regions", "m", D::kLength, 1e-4, 2.0, 1e-6, 20.0};
constexpr Quantity kVesselRadius{"radii of vessels", "m", D::kLength, 2e-4, 0.05, 1e-5, 1.0};
constexpr Quantity kVesselDiameter{"diameters of vessels", "m", D::kLength, 4e-4, 0.1, 2e-5, 2.0};
constexpr Quantity kVesselLength{"lengths of vessels", "m", D::kLength, 5e-4, 2.0, 1e-5, 20.0};
constexpr Quantity kGap{"gaps", "m", D::kLength, 1e-5, 0.05, 1e-7, 1.0};
constexpr Quantity kFacetLength{"facet lengths", "m", D::kLength, 5e-5, 0.1, 1e-6, 1.0};
constexpr Quantity kSurfaceDistance{"distances between surfaces", "m", D::kLength, 5e-6, 5e-3, 1e-7, 0.05};
constexpr Quantity kVesselCurvature{"curvatures of vessels", "1/m", D::kCurvature, 0.2, 1000.0, 0.0, 1e5};
constexpr Quantity kLesionLength{"lesion lengths", "m", D::kLength, 5e-4, 0.3, 1e-5, 2.0};

// Motion.
constexpr Quantity kInsertion{"insertions", "m", D::kLength, 0.0, 3.0, 0.0, 20.0};
constexpr Quantity kDisplacement{"displacements", "m", D::kLength, 0.0, 2.0, 0.0, 20.0};
constexpr Quantity kSpeed{"speeds", "m/s", D::kSpeed, 1e-4, 0.7, 1e-6, 5.0};
constexpr Quantity kSpeedLimit{"limits of a speed", "m/s", D::kSpeed, 1e-3, 2.0, 1e-6, 5.0};
constexpr Quantity kAcceleration{"accelerations of the hand", "m/s²", D::kAcceleration, 5e-3, 50.0, 1e-5, 1000.0};
constexpr Quantity kAngle{"angles", "rad", D::kAngle, 0.0, 2.001 * M_PI, 0.0, 1000.0};
constexpr Quantity kRotation{"rotations", "rad", D::kAngle, 0.0, 8.001 * M_PI, 0.0, 1e4};
constexpr Quantity kRotationRange{"ranges of a rotation", "rad", D::kAngle, 0.0, 1e4, 0.0, 1e5};
constexpr Quantity kAngularSpeed{"angular speeds", "rad/s", D::kAngularSpeed, 1e-3, 60.0, 0.0, 1e4};
constexpr Quantity kAngularAcceleration{"angular accelerations", "rad/s²", D::kOther, 0.05, 1000.0, 1e-4, 1e6};
constexpr Quantity kJointRatio{"ratios of a joint", "motion per motion of the joint", D::kOther, 1e-4, 1e6, 1e-9, 1e12};
constexpr Quantity kJointOffset{"offsets of a joint", "m, rad or Pa", D::kOther, 0.0, 1e7, 0.0, 1e8};
constexpr Quantity kBacklash{"plays of a joint", "m, rad or Pa", D::kOther, 1e-6, 1e5, 0.0, 1e7};
constexpr Quantity kSpeedScale{"speed factors", "1", D::kFraction, 0.05, 20.0, 1e-3, 1000.0};

// Times and rates.
constexpr Quantity kDuration{"durations", "s", D::kTime, 1e-4, 7200.0, 1e-6, 1e6};
constexpr Quantity kProfileTime{"times", "s", D::kTime, 0.0, 7200.0, 0.0, 1e6};
constexpr Quantity kReaction{"reaction times", "s", D::kTime, 5e-3, 10.0, 0.0, 1000.0};
constexpr Quantity kWait{"waiting times", "s", D::kTime, 1e-3, 900.0, 0.0, 1e5};
constexpr Quantity kTimeStep{"time steps", "s", D::kTime, 1e-5, 0.02, 1e-7, 0.1};
constexpr Quantity kDelay{"delays", "s", D::kTime, 1e-5, 0.5, 1e-7, 10.0};
constexpr Quantity kFrequency{"frequencies", "Hz", D::kFrequency, 1e-3, 100.0, 0.0, 1e4};
constexpr Quantity kRate{"rates", "Hz", D::kFrequency, 0.1, 2000.0, 1e-4, 1e5};
constexpr Quantity kFrameRate{"frame rates", "Hz", D::kFrequency, 0.5, 60.0, 1e-3, 1000.0};

// Forces.
constexpr Quantity kForceLimit{"force limits", "N", D::kForce, 0.02, 100.0, 1e-4, 1000.0};
constexpr Quantity kTorqueLimit{"torque limits", "N·m", D::kTorque, 1e-5, 1.0, 1e-8, 10.0};
constexpr Quantity kCutoff{"cutoff frequencies", "Hz", D::kFrequency, 5.0, 1000.0, 0.1, 1e5};
constexpr Quantity kResolution{"resolutions", "m", D::kLength, 1e-7, 2e-3, 1e-9, 0.1};
constexpr Quantity kAngularResolution{"angular resolutions", "rad", D::kAngle, 1e-6, 0.1, 1e-9, 10.0};
constexpr Quantity kForceRate{"rates of force", "N/s", D::kOther, 1.0, 1e5, 1e-3, 1e8};
constexpr Quantity kTorqueRate{"rates of torque", "N·m/s", D::kOther, 1e-3, 1e3, 1e-6, 1e6};
constexpr Quantity kHandForce{"forces of the hand", "N", D::kForce, 0.01, 60.0, 1e-4, 1000.0};
constexpr Quantity kValveFriction{"friction forces of a valve", "N", D::kForce, 1e-3, 10.0, 0.0, 100.0};
constexpr Quantity kLoadPosition{"positions along the wire", "m", D::kLength, 0.0, 4.0, 0.0, 10.0};
constexpr Quantity kRollerRadius{"radii of rollers", "m", D::kLength, 5e-4, 0.1, 1e-6, 1.0};
constexpr Quantity kPointForce{"point forces", "N", D::kForce, 1e-7, 5.0, 0.0, 1000.0};
constexpr Quantity kPointTorque{"point torques", "N·m", D::kTorque, 1e-9, 0.1, 0.0, 10.0};
constexpr Quantity kWallForce{"forces on the wall", "N", D::kForce, 1e-4, 10.0, 0.0, 1000.0};
constexpr Quantity kFitLoad{"fit loads", "N/m", D::kLineLoad, 1e-3, 200.0, 0.0, 1e5};
constexpr Quantity kDamperInsertion{"dampings", "N·s/m", D::kOther, 0.01, 1000.0, 1e-4, 1e5};
constexpr Quantity kDamperRotation{"rotational dampings", "N·m·s/rad", D::kOther, 1e-7, 1.0, 1e-10, 100.0};
constexpr Quantity kForceGain{"force gains", "m/(s·N)", D::kOther, 1e-4, 1.0, 1e-7, 100.0};
constexpr Quantity kTorqueGain{"torque gains", "rad/(s·N·m)", D::kOther, 1.0, 1e5, 1e-3, 1e8};
constexpr Quantity kGravity{"gravitational accelerations", "m/s²", D::kAcceleration, 0.01, 30.0, 0.0, 5000.0};
constexpr Quantity kDrag{"drag coefficients", "1", D::kOther, 0.01, 20.0, 0.0, 1e3};
constexpr Quantity kMassDamping{"dampings per mass", "1/s", D::kOther, 1e-3, 1e4, 0.0, 1e8};
constexpr Quantity kFriction{"friction coefficients", "1", D::kFraction, 1e-3, 1.5, 0.0, 10.0};
constexpr Quantity kPressure{"pressures", "Pa", D::kPressure, 1000.0, 5e6, 100.0, 1e8};
constexpr Quantity kPressureRange{"ranges of a pressure", "Pa", D::kPressure, 1000.0, 2e7, 0.0, 1e8};

// Circulation.
constexpr Quantity kHeartRate{"heart rates", "Hz", D::kFrequency, 0.4, 4.0, 0.05, 10.0};
constexpr Quantity kBreathingRate{"breathing rates", "Hz", D::kFrequency, 0.05, 1.0, 0.01, 10.0};
constexpr Quantity kBloodPressure{"blood pressures", "Pa", D::kPressure, 300.0, 3e4, 10.0, 1e5};
constexpr Quantity kBloodFlow{"flows of blood", "m³/s", D::kVolumeFlow, 1e-8, 5e-4, 1e-12, 5e-3};
constexpr Quantity kStrokeVolume{"stroke volumes", "m³", D::kVolume, 2e-5, 3e-4, 1e-7, 5e-3};
constexpr Quantity kViscosity{"viscosities of blood", "Pa·s", D::kOther, 1e-3, 0.02, 1e-5, 1.0};
constexpr Quantity kPulseTime{"parts of a heartbeat", "s", D::kTime, 5e-3, 5.0, 1e-4, 60.0};
constexpr Quantity kWallModulus{"elasticities of vessel walls", "Pa", D::kModulus, 1e3, 1e8, 1.0, 1e12};

// Contrast medium.
constexpr Quantity kInjectionVolume{"volumes of injections", "m³", D::kVolume, 5e-7, 1.5e-4, 1e-12, 1e-3};
constexpr Quantity kInjectionRate{"rates of injections", "m³/s", D::kVolumeFlow, 1e-7, 4e-5, 1e-12, 1e-3};
constexpr Quantity kInjectionRise{"rises of a rate", "s", D::kTime, 0.01, 2.0, 0.0, 1000.0};
constexpr Quantity kMediumViscosity{"viscosities of contrast media", "Pa·s", D::kOther, 1e-3, 0.03, 1e-5, 1.0};

// Materials and stiffness.
constexpr Quantity kDensity{"densities of instruments", "kg/m³", D::kDensity, 300.0, 25e3, 20.0, 1e5};
constexpr Quantity kFluidDensity{"fluid densities", "kg/m³", D::kDensity, 500.0, 2000.0, 0.0, 2e4};
constexpr Quantity kModulus{"moduli", "Pa", D::kModulus, 1e5, 1e12, 1e3, 1e14};
constexpr Quantity kPoisson{"Poisson ratios", "1", D::kOther, 0.0, 0.5, 0.0, 1.0};
constexpr Quantity kFlexuralRigidity{
    "bending and torsional stiffnesses", "N·m²", D::kFlexuralRigidity, 1e-10, 0.02, 1e-14, 1.0};
constexpr Quantity kAxialStiffness{"axial stiffnesses", "N", D::kForce, 0.5, 2e6, 1e-4, 1e9};
constexpr Quantity kWireCurvature{"rest curvatures", "1/m", D::kCurvature, 0.1, 2000.0, 0.0, 1e5};
constexpr Quantity kWallStiffness{"wall stiffnesses", "N/m²", D::kModulus, 1e3, 1e10, 1.0, 1e15};
constexpr Quantity kContactStiffness{"contact stiffnesses", "N/m", D::kStiffness, 100.0, 1e8, 0.1, 1e12};

// Discretisation.
constexpr Quantity kEdge{"edge lengths", "m", D::kLength, 2e-5, 0.1, 1e-10, 1.0};
constexpr Quantity kMargin{"contact margins", "m", D::kLength, 1e-5, 5e-3, 1e-7, 0.05};
constexpr Quantity kTravel{"travels per sub-step", "m", D::kLength, 1e-6, 0.01, 1e-8, 0.1};
constexpr Quantity kGuideLength{"guide lengths", "m", D::kLength, 1e-3, 0.3, 1e-6, 2.0};
constexpr Quantity kTurnPerEdge{"turning angles of an edge", "rad", D::kAngle, 1e-3, 1.0, 1e-6, 1.0};
constexpr Quantity kStrain{"strains", "1", D::kFraction, 1e-9, 0.01, 0.0, 1.0};

// X-ray imaging.
constexpr Quantity kSourceToDetector{"distances from source to detector", "m", D::kLength, 0.5, 2.5, 0.05, 10.0};
constexpr Quantity kSourceToPatient{"distances from source to patient", "m", D::kLength, 0.2, 2.0, 0.02, 10.0};
constexpr Quantity kDetectorWidth{"widths of a detector", "m", D::kLength, 0.05, 0.8, 1e-3, 5.0};
constexpr Quantity kTissue{"tissue thicknesses", "m", D::kLength, 5e-3, 0.8, 0.0, 5.0};
constexpr Quantity kImagingAngle{"angles of a C-arm", "rad", D::kAngle, 0.0, 1.001 * M_PI, 0.0, 3.2};
constexpr Quantity kImagingDegrees{"angles of a C-arm", "degrees", D::kOther, 0.0, 180.0, 0.0, 180.0};
constexpr Quantity kGantryAngularSpeed{"angular speeds of a C-arm", "rad/s", D::kAngularSpeed, 0.01, 3.0, 1e-4, 20.0};
constexpr Quantity kClearance{"clearances of a detector", "m", D::kLength, 0.01, 0.6, 0.0, 5.0};
constexpr Quantity kStroke{"strokes of a table", "m", D::kLength, 0.01, 3.0, 0.0, 20.0};
constexpr Quantity kPhotonEnergy{"photon energies", "keV", D::kEnergy, 30.0, 100.0, 1.0, 1000.0};
constexpr Quantity kRatio{"image settings", "1", D::kOther, 0.0, 8.0, 0.0, 100.0};
constexpr Quantity kTubeVoltage{"tube voltages", "kV", D::kOther, 50.0, 125.0, 1.0, 1000.0};
constexpr Quantity kFilter{"thicknesses of beam filters", "m", D::kLength, 5e-5, 0.01, 0.0, 0.1};
constexpr Quantity kDetectorDose{"detector doses per frame", "Gy", D::kOther, 5e-9, 2e-6, 1e-10, 1e-3};
constexpr Quantity kDoseRate{"air kerma rates", "Gy/s", D::kOther, 1e-5, 5e-3, 1e-8, 1.0};
constexpr Quantity kIodine{"iodine concentrations", "mgI/ml", D::kConcentration, 1.0, 500.0, 0.0, 5000.0};
constexpr Quantity kMaterialDensity{"densities of materials", "g/cm³", D::kGramDensity, 0.1, 25.0, 1e-3, 100.0};

// Sensors.
constexpr Quantity kPositionError{"errors of a position", "m", D::kLength, 1e-6, 0.02, 0.0, 1.0};
constexpr Quantity kAngleError{"errors of an angle", "rad", D::kAngle, 1e-6, 0.5, 0.0, 3.2};
constexpr Quantity kForceError{"errors of a force", "N", D::kForce, 1e-5, 2.0, 0.0, 100.0};
constexpr Quantity kTorqueError{"errors of a torque", "N·m", D::kTorque, 1e-9, 0.05, 0.0, 10.0};
constexpr Quantity kPixelError{"errors on a detector", "pixel", D::kOther, 1e-3, 50.0, 0.0, 1e4};

// Pure numbers.
constexpr Quantity kCount{"counts", "1", D::kOther, 0.0, 1000.0, 0.0, 1e6};
constexpr Quantity kFraction{"fractions", "1", D::kFraction, 0.0, 1.0, 0.0, 1.0};
constexpr Quantity kDirection{"components of a direction", "1", D::kOther, 0.0, 1000.0, 0.0, 1e9};
constexpr Quantity kRotationMatrix{"components of a rotation", "1", D::kOther, 0.0, 1.001, 0.0, 2.0};
constexpr Quantity kBlend{"blending ranges", "1", D::kOther, 0.05, 3.0, 0.01, 10.0};
constexpr Quantity kHeatScale{"scales of the force map", "1", D::kOther, 1e-4, 100.0, 1e-7, 1e4};
constexpr Quantity kNumber{"numbers", "1", D::kOther, 0.0, 1e300, 0.0, 1e300};  // of any magnitude
constexpr Quantity kScale{"factors", "1", D::kOther, 0.1, 10.0, 1e-3, 1e3};

}  // namespace endovascular_sim::quantities
