#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <string>

#include "test/fuzz/small_session_bag.h"
#include "test/haptics/host_fixture.h"
#include "test/vessel/io/mesh_files.h"
#include "test/vessel/io/vtk_files.h"

// Writes the corpora of the fuzz targets: make_corpus FOLDER. Run it again when a format changes.

using namespace endovascular_sim;  // NOLINT: a program's main file

namespace
{

std::string folder;

void write(const std::string& target, const std::string& name, const std::string& bytes)
{
  std::filesystem::create_directories(folder + "/" + target);
  std::ofstream(folder + "/" + target + "/" + name, std::ios::binary) << bytes;
}

std::string contentOf(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void writeSerial()
{
  haptics::test::Bench bench;
  std::string to_host(1, '\x40');
  std::string to_device(1, '\x41');
  for (int k = 0; k < 40; ++k)
  {
    ++bench.milliseconds;
    bench.now += 1e-3;
    bench.device.sendSample({bench.milliseconds * 1000U, 1e-4F * static_cast<float>(k), 0.0F, bench.flags});
    haptics::Bytes bytes = bench.device.takeOutput();
    to_host.append(bytes.begin(), bytes.end());
    bench.host.receive(bytes.data(), bytes.size(), bench.now, bench.wall);
    bench.host.commandForce({1.0, 0.01}, haptics::HandMotion(), bench.now);
    bench.host.tick(bench.now, bench.wall);
    bench.host.output().flush(bench.sink, bench.now);
    bytes = bench.sink.take();
    to_device.append(bytes.begin(), bytes.end());
    bench.device.receive(bytes.data(), bytes.size(), bench.now);
  }
  write("serial", "to_host", to_host);
  write("serial", "to_device", to_device);
}

void writeMeshes()
{
  using vessel::MeshFormat;
  for (const MeshFormat format :
       {MeshFormat::kObj, MeshFormat::kRelativeObj, MeshFormat::kAsciiStl, MeshFormat::kBinaryStl,
        MeshFormat::kAsciiPly, MeshFormat::kLittleEndianPly, MeshFormat::kBigEndianPly})
  {
    const std::string extension = vessel::extensionOf(format);
    const char selector = extension == ".obj" ? '\0' : extension == ".stl" ? '\1' : '\2';
    write("mesh", vessel::nameOf(format), selector + vessel::meshFile(vessel::capsule(4, 2), format));
  }
  vessel::VtkContent content = vessel::surfaceContent(vessel::capsule(4, 2));
  content.lines = {{12, 13}, {12, 4}};
  content.strips = {{0, 1, 4, 5}};
  content.radii.assign(content.points.size(), 2.0);
  content.space = "RAS";
  for (const vessel::VtkStorage storage : vessel::kVtkStorages)
    write("mesh", std::string("Vtk") + vessel::nameOf(storage),
          (vessel::isLegacy(storage) ? '\4' : '\3') + vessel::vtkFile(content, storage));
}

void writeScenes()
{
  for (const char* name : {"straight_wire", "tube", "cantilever", "stent", "pci"})
    write("scene", name, contentOf(std::string(PROJECT_DIR "/config/scenes/") + name + ".yaml"));
  for (const char* name : {"tube", "catheter"})
    write("scene", std::string(name) + "_resolved",
          scene::loadScene(std::string(PROJECT_DIR "/config/scenes/") + name + ".yaml").resolved_yaml);
}

void writeState()
{
  fuzz::SmallSimulation small;
  small.simulation.stepAll(simulation::commandsAt(small.scene, small.scene.solver.time_step));
  std::ostringstream stream;
  small.simulation.save(stream, 0);
  write("state", "straight_wire", std::string(1, '\0') + stream.str());
}

void writeBag()
{
  std::filesystem::create_directories(folder + "/bag");
  fuzz::writeSmallSession(folder + "/bag/session", rosbag::compression::Uncompressed);
}

}  // namespace

int main(int argc, char** argv)
{
  if (argc != 2)
  {
    std::cerr << "usage: make_corpus FOLDER\n";
    return 2;
  }
  folder = argv[1];
  writeSerial();
  writeMeshes();
  writeScenes();
  writeState();
  writeBag();
  return 0;
}
