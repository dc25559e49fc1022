#include "robot/urdf_source.h"

#include "common/error.h"

namespace endovascular_sim::robot
{
namespace
{

UrdfReader registered_reader = nullptr;  // constant after the initialisation of the program

}  // namespace

RobotModel loadUrdf(const std::string& file)
{
  if (registered_reader == nullptr)
    throw InputError(file, "", "this program cannot read URDF files; link it with endovascular_sim::robot");
  return registered_reader(file);
}

bool registerUrdfReader(UrdfReader reader)
{
  registered_reader = reader;
  return true;
}

}  // namespace endovascular_sim::robot
