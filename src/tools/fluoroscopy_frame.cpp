// Renders one fluoroscopy frame of a mesh, and optionally of a wire, into a PNG file.

#include <cmath>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "common/error.h"
#include "fluoroscopy/attenuation.h"
#include "fluoroscopy/fluoroscope.h"
#include "fluoroscopy/png_writer.h"
#include "vessel/io/mesh_reader.h"

namespace endovascular_sim
{
namespace
{

constexpr auto kHelp = R"(Renders one fluoroscopy frame into a PNG file.

  fluoroscopy_frame --mesh FILE --table FILE --out FILE.png [options]

  --mesh FILE          closed triangle mesh of the vessel (OBJ, STL, PLY); faces may point in or out
  --unit U             metres per unit of the mesh and the wire [0.001]
  --left AXIS          axis of the mesh towards the patient's left: x, -x, y, -y, z or -z [x]
  --head AXIS          axis of the mesh towards the head [z]; the patient frame is x left, y posterior, z head
  --wire FILE.csv      wire: a row x,y,z per node, proximal to distal, in the frame and unit of the mesh
  --radius R           of the wire [0.00018 m]
  --tip L              length of the platinum tip; the rest is nitinol [0.03 m]
  --table FILE         attenuation table (config/xray/attenuation.yaml)
  --lao DEG            primary angle, LAO positive [0]
  --cranial DEG        secondary angle, cranial positive [0]
  --isocentre X,Y,Z    in the patient frame, in the unit of the mesh [the wire's tip, else the centre of the mesh]
  --sid M --sod M      distances source to detector and to isocentre [1.2] [0.75]
  --detector M         width of the detector [0.3]
  --pixels N           along a side [512]
  --energy KEV         photon energy [60]
  --iodine MG          iodine in the vessel [150 mgI/ml]
  --tissue M           thickness of soft tissue [0.2]
  --raw                write the linear 16-bit detector signal instead of the display image
)";

class Options
{
public:
  Options(int argc, char** argv)
  {
    static const std::map<std::string, std::string> kDefaults = {
        {"--mesh", ""},          {"--unit", "0.001"}, {"--left", "x"},     {"--head", "z"},       {"--wire", ""},
        {"--radius", "0.00018"}, {"--tip", "0.03"},   {"--table", ""},     {"--lao", "0"},        {"--cranial", "0"},
        {"--isocentre", ""},     {"--sid", "1.2"},    {"--sod", "0.75"},   {"--detector", "0.3"}, {"--pixels", "512"},
        {"--energy", "60"},      {"--iodine", "150"}, {"--tissue", "0.2"}, {"--out", ""}};
    values_ = kDefaults;
    for (int i = 1; i < argc; ++i)
    {
      const std::string key = argv[i];
      if (key == "--raw")
        raw_ = true;
      else if (values_.count(key) == 0)
        throw InputError("command line", key, "unknown option; --help lists them");
      else if (++i == argc)
        throw InputError("command line", key, "needs a value");
      else
        values_[key] = argv[i];
    }
    for (const char* key : {"--mesh", "--table", "--out"})
      if (values_.at(key).empty())
        throw InputError("command line", key, "missing; --help explains it");
  }

  const std::string& text(const std::string& key) const { return values_.at(key); }
  bool raw() const { return raw_; }

  std::vector<double> numbers(const std::string& key, std::size_t count) const
  {
    std::string text = values_.at(key);
    for (char& c : text)
      c = c == ',' ? ' ' : c;
    std::istringstream words(text);
    std::vector<double> values(count);
    std::string rest;
    for (double& value : values)
      words >> value;
    if (!words || words >> rest)
      throw InputError("command line", key, "needs " + std::to_string(count) + " number(s), separated by commas");
    return values;
  }

  double number(const std::string& key) const { return numbers(key, 1).front(); }

private:
  std::map<std::string, std::string> values_;
  bool raw_ = false;
};

Eigen::Vector3d axisOf(const Options& options, const std::string& key)
{
  const std::string& text = options.text(key);
  const bool negative = !text.empty() && text.front() == '-';
  const auto axis = std::string("xyz").find(negative ? text.substr(1) : text);
  if (axis == std::string::npos || text.size() != (negative ? 2U : 1U))
    throw InputError("command line", key, "must be x, -x, y, -y, z or -z");
  return (negative ? -1.0 : 1.0) * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis));
}

/** Rotation from the mesh's frame to the patient's: x left, y posterior, z head. */
Eigen::Matrix3d patientFromMesh(const Options& options)
{
  const Eigen::Vector3d left = axisOf(options, "--left"), head = axisOf(options, "--head");
  if (left.dot(head) != 0.0)
    throw InputError("command line", "--left", "must not lie along --head");
  Eigen::Matrix3d rotation;
  rotation << left.transpose(), head.cross(left).transpose(), head.transpose();
  return rotation;
}

std::vector<Eigen::Vector3d> readNodes(const std::string& file, const Eigen::Matrix3d& patient_from_mesh, double unit)
{
  std::ifstream stream(file);
  if (!stream)
    throw InputError(file, "", "cannot be read");
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
      throw InputError(file, "line " + std::to_string(number), "must hold x,y,z");
  }
  return nodes;
}

fluoroscopy::XRayWire makeWire(const Options& options, const fluoroscopy::AttenuationTable& table,
                               const Eigen::Matrix3d& patient_from_mesh)
{
  fluoroscopy::XRayWire wire;
  if (options.text("--wire").empty())
    return wire;
  wire.nodes = readNodes(options.text("--wire"), patient_from_mesh, options.number("--unit"));
  wire.radius.assign(wire.nodes.size(), options.number("--radius"));
  if (wire.nodes.size() < 2)
    throw InputError(options.text("--wire"), "", "must hold at least two nodes");
  const double energy = options.number("--energy");
  const double displaced = table.contrast(options.number("--iodine"), energy);
  double to_tip = 0.0;
  wire.attenuation.resize(wire.nodes.size() - 1);
  for (std::size_t j = wire.nodes.size() - 1; j-- > 0;)
  {
    const double length = (wire.nodes[j + 1] - wire.nodes[j]).norm();
    const char* material = to_tip + 0.5 * length < options.number("--tip") ? "platinum" : "nitinol";
    wire.attenuation[j] = table.linear(material, energy) - displaced;
    to_tip += length;
  }
  return wire;
}

geometry::TriangleMesh readVessel(const Options& options, const Eigen::Matrix3d& patient_from_mesh)
{
  geometry::TriangleMesh mesh = vessel::readMesh(options.text("--mesh"), options.number("--unit"));
  for (Eigen::Vector3d& vertex : mesh.vertices)
    vertex = patient_from_mesh * vertex;
  if (mesh.signedVolume() < 0.0)
    for (Eigen::Vector3i& triangle : mesh.triangles)
      std::swap(triangle[1], triangle[2]);
  return mesh;
}

fluoroscopy::CArmPose makePose(const Options& options, const geometry::TriangleMesh& mesh,
                               const fluoroscopy::XRayWire& wire)
{
  constexpr double kDegree = 3.14159265358979323846 / 180.0;
  fluoroscopy::CArmPose pose;
  pose.primary_angle = options.number("--lao") * kDegree;
  pose.secondary_angle = options.number("--cranial") * kDegree;
  pose.source_to_detector = options.number("--sid");
  pose.source_to_patient = options.number("--sod");
  pose.detector_width = options.number("--detector");
  pose.pixels = static_cast<int>(options.number("--pixels"));
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  pose.isocentre = wire.nodes.empty() ? box.center() : wire.nodes.back();
  if (!options.text("--isocentre").empty())
    pose.isocentre = options.number("--unit") * Eigen::Vector3d(options.numbers("--isocentre", 3).data());
  return pose;
}

void run(const Options& options)
{
  const auto table = fluoroscopy::AttenuationTable::load(options.text("--table"));
  const Eigen::Matrix3d patient_from_mesh = patientFromMesh(options);
  const fluoroscopy::XRayWire wire = makeWire(options, table, patient_from_mesh);
  const geometry::TriangleMesh mesh = readVessel(options, patient_from_mesh);
  const double energy = options.number("--energy");
  fluoroscopy::XRayScene scene;
  scene.tissue_attenuation = table.linear("soft_tissue", energy);
  scene.vessel_attenuation = table.contrast(options.number("--iodine"), energy);
  scene.tissue_thickness = options.number("--tissue");
  fluoroscopy::Fluoroscope fluoroscope(makePose(options, mesh, wire), scene);
  fluoroscope.setVessel(mesh);
  const fluoroscopy::Frame& frame = fluoroscope.render({wire});
  if (options.raw())
    fluoroscopy::writePng(options.text("--out"), frame.pixels, frame.pixels, frame.raw);
  else
    fluoroscopy::writePng(options.text("--out"), frame.pixels, frame.pixels, frame.image);
}

}  // namespace
}  // namespace endovascular_sim

int main(int argc, char** argv)
{
  using endovascular_sim::Options;
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]) == "--help" || std::string(argv[i]) == "-h")
    {
      std::cout << endovascular_sim::kHelp;
      return 0;
    }
  try
  {
    endovascular_sim::run(Options(argc, argv));
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << "fluoroscopy_frame: " << error.what() << '\n';
    return 1;
  }
}
