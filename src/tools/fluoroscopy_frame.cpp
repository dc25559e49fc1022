#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/input_file.h"
#include "common/progress.h"
#include "common/quantities.h"
#include "common/units.h"
#include "fluoroscopy/beam/material_library.h"
#include "fluoroscopy/fluoroscope.h"
#include "fluoroscopy/image/png_writer.h"
#include "fluoroscopy/projection/coaxial_stack.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/repair/mesh_check.h"
#include "vessel/repair/mesh_size.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file

struct Options
{
  std::string mesh;
  std::string materials;
  std::string out;
  std::string wire;
  std::string left = "x";
  std::string head = "z";
  double unit = 1e-3;        ///< length of a unit of mesh and wire [m]
  double radius = 1.8e-4;    ///< radius of the wire [m]
  double tip_length = 0.03;  ///< length of the platinum tip [m]
  double lao = 0.0;          ///< primary angle [°]
  double cranial = 0.0;      ///< secondary angle [°]
  std::string isocentre;     ///< x,y,z in units of the mesh; empty: default
  double source_to_detector = 1.2;
  double source_to_patient = 0.75;
  double detector_width = 0.3;
  int pixels = 512;
  double tube_voltage = 80.0;    ///< [kV]
  double copper = 0.2e-3;        ///< filtration with copper [m]
  double detector_dose = 30e-9;  ///< air kerma at the detector [Gy]
  unsigned long long seed = 0;   ///< of the noise
  double iodine = 150.0;         ///< iodine concentration in the vessel [mg/ml]
  double tissue = 0.2;           ///< thickness of soft tissue [m]
  bool raw = false;
};

/** Three numbers separated by commas; nothing for another text. */
std::optional<Eigen::Vector3d> pointOf(const std::string& text)
{
  Eigen::Vector3d point;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &point.x(), &point.y(), &point.z(), &rest) != 3)
    return std::nullopt;
  return point;
}

/** Unit vector of an axis; @p name is one of x, -x, y, -y, z and -z. */
Eigen::Vector3d axisOf(const std::string& name)
{
  const bool negative = name.front() == '-';
  return (negative ? -1.0 : 1.0) * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(name.back() - 'x'));
}

void addOptions(tools::CommandLine& line, Options& options)
{
  const CLI::IsMember axes({"x", "-x", "y", "-y", "z", "-z"});
  line.option("--mesh", options.mesh, "FILE",
              "closed triangle mesh of the vessel (OBJ, STL, PLY, VTP, VTK), oriented inwards or outwards")
      ->required();
  line.option("--materials", options.materials, "FILE", "materials (config/xray/materials.yaml)")->required();
  line.option("--out", options.out, "FILE.png", "image to write")->required();
  line.quantity("--unit", options.unit, "U", quantities::kMeshUnit,
                "length of a unit of the mesh and the wire [0.001 m]");
  line.option("--left", options.left, "AXIS", "axis of the mesh towards the patient's left: x, -x, y, -y, z or -z [x]")
      ->check(axes);
  line.option("--head", options.head, "AXIS",
              "axis of the mesh towards the head; the patient frame is x left, y posterior, z head [z]")
      ->check(axes);
  line.option("--wire", options.wire, "FILE.csv",
              "wire: a row x,y,z per node, proximal to distal, in the frame and unit of the mesh");
  line.quantity("--radius", options.radius, "R", quantities::kWireRadius, "radius of the wire [0.00018 m]");
  line.quantity("--tip", options.tip_length, "L", quantities::kTipLeg,
                "length of the platinum tip; the rest is nitinol [0.03 m]");
  line.quantity("--lao", options.lao, "DEG", quantities::kImagingDegrees, "primary angle, LAO positive [0]");
  line.quantity("--cranial", options.cranial, "DEG", quantities::kImagingDegrees,
                "secondary angle, cranial positive [0]");
  line.option("--isocentre", options.isocentre, "X,Y,Z",
              "isocentre in the patient frame, in units of the mesh [the wire's tip, else the centre of the mesh]")
      ->check([](const std::string& text)
              { return pointOf(text) ? "" : "requires three numbers separated by commas"; });
  line.quantity("--sid", options.source_to_detector, "M", quantities::kSourceToDetector,
                "distance from source to detector [1.2]");
  line.quantity("--sod", options.source_to_patient, "M", quantities::kSourceToPatient,
                "distance from source to isocentre [0.75]");
  line.quantity("--detector", options.detector_width, "M", quantities::kDetectorWidth, "width of the detector [0.3]");
  line.option("--pixels", options.pixels, "N", "pixels along a side [512]");
  line.quantity("--kv", options.tube_voltage, "KV", quantities::kTubeVoltage, "tube voltage [80]");
  line.quantity("--copper", options.copper, "M", quantities::kFilter,
                "filtration with copper, besides 2.5 mm of aluminium [0.0002]");
  line.quantity("--dose", options.detector_dose, "GY", quantities::kDetectorDose,
                "air kerma at the detector [3e-8]; cine 1.5e-7");
  line.option("--seed", options.seed, "N", "seed of the noise [0]");
  line.quantity("--iodine", options.iodine, "MG", quantities::kIodine,
                "iodine concentration in the vessel [150 mg/ml]");
  line.quantity("--tissue", options.tissue, "M", quantities::kTissue, "thickness of soft tissue [0.2]");
  line.flag("--raw", options.raw, "writes the linear 16-bit detector signal instead of the display image");
  line.require(
      [&options] {
        return axisOf(options.left).dot(axisOf(options.head)) == 0.0 ? "" : "--left and --head require different axes";
      });
}

/** Rotation from the mesh's frame to the patient's: x left, y posterior, z head. */
Eigen::Matrix3d patientFromMesh(const Options& options)
{
  const Eigen::Vector3d left = axisOf(options.left), head = axisOf(options.head);
  Eigen::Matrix3d rotation;
  rotation << left.transpose(), head.cross(left).transpose(), head.transpose();
  return rotation;
}

std::vector<Eigen::Vector3d> readNodes(const std::string& file, const Eigen::Matrix3d& patient_from_mesh, double unit)
{
  std::ifstream stream = openInputFile(file, "give a CSV file with x,y,z of a node on every line");
  std::vector<Eigen::Vector3d> nodes;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number)
  {
    for (char& c : line)
      c = c == ',' ? ' ' : c;
    std::istringstream words(line);
    Eigen::Vector3d p;
    if (words >> p.x() >> p.y() >> p.z())
      nodes.emplace_back(unit * (patient_from_mesh * p));
    else if (number > 1)
      throw InputError(file, "line " + std::to_string(number), "requires x,y,z");
  }
  return nodes;
}

/** Centreline of the wire in the patient frame; empty without a wire. */
std::vector<Eigen::Vector3d> readWire(const Options& options, const Eigen::Matrix3d& patient_from_mesh)
{
  if (options.wire.empty())
    return {};
  std::vector<Eigen::Vector3d> nodes = readNodes(options.wire, patient_from_mesh, options.unit);
  if (nodes.size() < 2)
    throw InputError(options.wire, "", "requires at least two nodes");
  return nodes;
}

/** Wire of nitinol with a tip of platinum, in the contrast medium. */
fluoroscopy::XRayWire makeWire(const Options& options, const fluoroscopy::Fluoroscope& fluoroscope,
                               const std::vector<Eigen::Vector3d>& nodes)
{
  instrument::Instrument instrument;
  instrument.name = "wire";
  instrument.wire.sections.resize(2);
  instrument.wire.sections[0].length = 10.0;
  instrument.wire.sections[1].length = options.tip_length;
  for (rod::Section& section : instrument.wire.sections)
    section.radius = options.radius;
  instrument.materials = {instrument::Material::kNitinol, instrument::Material::kPlatinum};
  return fluoroscopy::coaxialStack(nodes, {fluoroscopy::XRayInstrument(instrument, fluoroscope.materials())}, {0.0},
                                   {fluoroscope.vesselFluids()});
}

geometry::TriangleMesh readVessel(const Options& options, const Eigen::Matrix3d& patient_from_mesh)
{
  vessel::MeshRemarks remarks;
  geometry::TriangleMesh mesh = vessel::readMesh(options.mesh, options.unit, progressOnErrorStream(), &remarks);
  tools::printWarnings("fluoroscopy_frame", remarks.warnings);
  tools::printNotes(options.mesh, remarks.notes);
  if (mesh.signedVolume() < 0.0)
    for (Eigen::Vector3i& triangle : mesh.triangles)
      std::swap(triangle[1], triangle[2]);
  // The check of the vessel server. Path lengths through an open or inconsistently oriented mesh have no meaning.
  const vessel::MeshReport report = vessel::checkMesh(mesh);
  vessel::requirePlausibleSize(mesh, report, options.unit, options.mesh);
  vessel::requireClean(report, options.mesh);
  for (Eigen::Vector3d& vertex : mesh.vertices)
    vertex = patient_from_mesh * vertex;
  return mesh;
}

fluoroscopy::CArmPose makePose(const Options& options, const geometry::TriangleMesh& mesh,
                               const std::vector<Eigen::Vector3d>& wire)
{
  using units::kDegree;
  fluoroscopy::CArmPose pose;
  pose.primary_angle = options.lao * kDegree;
  pose.secondary_angle = options.cranial * kDegree;
  pose.source_to_detector = options.source_to_detector;
  pose.source_to_patient = options.source_to_patient;
  pose.detector_width = options.detector_width;
  pose.pixels = options.pixels;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  pose.isocentre = wire.empty() ? box.center() : wire.back();
  if (!options.isocentre.empty())
    pose.isocentre = options.unit * *pointOf(options.isocentre);
  return pose;
}

int run(const Options& options)
{
  const auto library = fluoroscopy::MaterialLibrary::load(options.materials);
  tools::printWarnings("fluoroscopy_frame", library.warnings());
  const Eigen::Matrix3d patient_from_mesh = patientFromMesh(options);
  const std::vector<Eigen::Vector3d> nodes = readWire(options, patient_from_mesh);
  const geometry::TriangleMesh mesh = readVessel(options, patient_from_mesh);
  fluoroscopy::XRayScene scene;
  scene.beam.tube_voltage = options.tube_voltage;
  scene.beam.copper = options.copper;
  scene.exposure.detector_dose = options.detector_dose;
  scene.tissue_thickness = options.tissue;
  scene.iodine = options.iodine;
  scene.seed = options.seed;
  fluoroscopy::Fluoroscope fluoroscope(makePose(options, mesh, nodes), scene, library);
  fluoroscope.setVessel(mesh);
  const fluoroscopy::Frame& frame = fluoroscope.render({makeWire(options, fluoroscope, nodes)});
  if (options.raw)
    fluoroscopy::writePng(options.out, frame.pixels, frame.pixels, frame.raw);
  else
    fluoroscopy::writePng(options.out, frame.pixels, frame.pixels, frame.image);
  return 0;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line("fluoroscopy_frame",
                          "Renders one fluoroscopy frame of a vessel mesh, and optionally of a wire, into a PNG file.",
                          "Exit code: 0 success; 1 a file cannot be used (the reason is on the error stream); 2 wrong "
                          "arguments.");
  addOptions(line, options);
  return line.run(argc, argv, [&options] { return run(options); });
}
