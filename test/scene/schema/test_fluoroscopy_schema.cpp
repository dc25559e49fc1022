#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::scene
{
namespace
{

const std::string kTube = "vessel: {friction: 0.1, tube: {radius: 0.005, pieces: [{length: 0.3}]}}\n";

std::string sceneText(const std::string& fluoroscopy, const std::string& vessel = kTube)
{
  return "name: s\n" + vessel +
         "instrument: {use: guidewire_035_j}\ndrive: {source: topic}\nfluoroscopy: " + fluoroscopy + "\n";
}

TEST(FluoroscopySchema, APatientIsABodyOrACtWithItsRegistration)
{
  EXPECT_FALSE(parseScene(sceneText("{}"), "s.yaml").fluoroscopy->patient);
  EXPECT_FALSE(parseScene(sceneText("{patient: none}"), "s.yaml").fluoroscopy->patient);
  EXPECT_TRUE(parseScene(sceneText("{patient: {body: true}}"), "s.yaml").fluoroscopy->patient->body);
  const std::string volume = testing::TempDir() + "schema_patient.vol";
  std::ofstream(volume) << "content is read later";
  const Scene plain = parseScene(sceneText("{patient: {ct: " + volume + "}}"), "s.yaml");
  EXPECT_EQ(plain.fluoroscopy->patient->ct, volume);
  EXPECT_FALSE(plain.fluoroscopy->patient->patient_from_ct) << "the transform of the vessel's mesh applies";
  const Scene moved = parseScene(
      sceneText("{patient: {ct: " + volume + ", head: [0, 1, 0], left: [1, 0, 0], translation: [0.1, 0.2, 0.3]}}"),
      "s.yaml");
  const Eigen::Isometry3d& transform = *moved.fluoroscopy->patient->patient_from_ct;
  EXPECT_TRUE((transform * Eigen::Vector3d(0.0, 1.0, 0.0)).isApprox(Eigen::Vector3d(0.1, 0.2, 1.3)));
  const Scene again = parseScene(moved.resolved_yaml, "s.yaml");
  EXPECT_EQ(again.resolved_yaml, moved.resolved_yaml);
  EXPECT_TRUE(again.fluoroscopy->patient->patient_from_ct->isApprox(transform));
}

TEST(FluoroscopySchema, WrongPatientsAreRefusedByKeyAndRemedy)
{
  struct Refusal
  {
    std::string text;
    std::string key;
    std::string remedy;
  };
  const std::vector<Refusal> refusals = {
      {sceneText("{patient: {}}"), "fluoroscopy.patient.body", "set body: true, ct: FILE.vol, or remove patient"},
      {sceneText("{patient: {body: false}}"), "fluoroscopy.patient.body", "neither body nor ct is given"},
      {sceneText("{patient: {body: true, ct: a.vol}}"), "fluoroscopy.patient.body", "conflicts with ct"},
      {sceneText("{patient: {ct: absent.vol}}"), "fluoroscopy.patient.ct", "no such file"},
      {sceneText("{patient: {ct: a.vol, rotation: [[1, 0, 0], [0, 1, 0], [0, 0, 2]]}}"), "fluoroscopy.patient.rotation",
       "is not a rotation"},
      {sceneText("{patient: {body: true, translation: [0, 0, 0]}}"), "fluoroscopy.patient.translation", ""},
      {sceneText("{patient: {body: true}, tissue_thickness: 0.2}"), "fluoroscopy.tissue_thickness",
       "conflicts with patient"},
      {sceneText("{patient: {body: true}}", ""), "fluoroscopy.patient.body", "placed about a vessel"}};
  for (const Refusal& refusal : refusals)
  {
    const std::string message = inputErrorOf([&] { parseScene(refusal.text, "s.yaml"); });
    EXPECT_NE(message.find(refusal.key), std::string::npos) << refusal.text << ": " << message;
    EXPECT_NE(message.find(refusal.remedy), std::string::npos) << refusal.text << ": " << message;
  }
}

}  // namespace
}  // namespace endovascular_sim::scene
