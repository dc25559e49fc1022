#pragma once

#include <string>
#include <vector>

namespace endovascular_sim::yaml
{
class Fields;
}

namespace endovascular_sim::flow
{

/** Vessels behind a named branch: all outlets of the network whose nearest named ancestor it is. */
struct Territory
{
  std::string branch;   ///< name of a branch of the centreline
  double share = 0.0;   ///< of the cardiac output at rest [1]
  double muscle = 0.0;  ///< pressure around its small vessels, relative to that in the left ventricle [1]; 0: none
};

/** Heart of a circulation. */
struct HeartSettings
{
  double rate = 70.0 / 60.0;         ///< [Hz]
  double output = 5e-3 / 60.0;       ///< cardiac output at rest [m³/s]
  double largest_stroke = 1.2e-4;    ///< stroke volume at low rates [m³]
  double contraction = 0.05;         ///< isovolumic contraction [s]
  double relaxation = 0.08;          ///< isovolumic relaxation [s]
  double filling_pressure = 1000.0;  ///< of the left ventricle in diastole [Pa]
  double largest_pressure = 4e4;     ///< in the left ventricle, against which it ejects nothing [Pa]
  double backflow = 0.02;            ///< volume that returns while the aortic valve closes, relative to the stroke [1]
  double closure = 0.04;             ///< duration of the valve's closure [s]
};

/** Elasticity of walls, Eh/r = k₁ exp(k₂ r) + k₃ (Olufsen 1999, eq. 2.23). */
struct WallElasticity
{
  double k1 = 2.0e6;         ///< [Pa]
  double k2 = -2253.0;       ///< [1/m]
  double k3 = 8.65e4;        ///< [Pa]
  double pressure = 1.06e4;  ///< at which vessels have their given radii [Pa]

  double at(double radius) const;  ///< Eh/r [Pa]. @param radius [m]
};

/** Circulation of a person: blood, heart, walls and the vessels behind the outlets. */
struct Circulation
{
  double density = 1060.0;  ///< of blood [kg/m³]
  double viscosity = 4e-3;  ///< of blood [Pa·s]
  HeartSettings heart;
  WallElasticity wall;
  double mean_pressure = 1.24e4;   ///< in the aorta at rest [Pa]
  double venous_pressure = 700.0;  ///< [Pa]
  double decay = 1.3;              ///< time constant R·C of the outlets [s]
  double muscle_decay = 0.24;      ///< the same of those in the muscle of the heart [s]
  double muscle_proximal = 0.5;    ///< share of their resistance in front of their compliance [1]
  double hyperaemia = 3.5;         ///< factor by which their resistance falls in hyperaemia [1]
  std::vector<Territory> territories;
};

/** Schema of a circulation: the file of one, and the key `flow.circulation` of a scene. */
void visitCirculation(yaml::Fields& fields, Circulation& circulation);

/** Reads a circulation.
 *  @throws InputError that names the key, e.g. for shares whose sum is above one */
Circulation readCirculation(const std::string& file);

}  // namespace endovascular_sim::flow
