#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::scene
{
namespace
{

const std::string kFolder = TEST_DATA_DIR "/scenes/";

struct Refusal
{
  std::string file;      ///< below test/data/scenes
  std::string location;  ///< key path and line
  std::string remedy;    ///< words of the remedy
};

const std::vector<Refusal> kRefusals = {
    {"bad_unknown_key.yaml", "sovler (line 12)", "did you mean \"solver\"?"},
    {"bad_unknown_nested_key.yaml", "drive.speeed (line 14)", "did you mean \"speed\"?"},
    {"bad_unknown_key_without_neighbour.yaml", "record.colour_scheme (line 13)",
     "known keys: pose_rate, trajectory_rate, wall_force_threshold, x_ray_frames"},
    {"bad_name_of_a_path.yaml", "name (line 1)", "must consist of at most 100 letters, digits, _, - and ."},
    {"bad_name_with_a_space.yaml", "name (line 1)", "letters, digits, _, - and ., with a letter, digit or _ first"},
    {"bad_misspelt_required_key.yaml", "instrument.sections.0.densty (line 9)", "did you mean \"density\"?"},
    {"bad_missing_instrument.yaml", "instrument (line 1)", "give a file"},
    {"bad_missing_instrument_file.yaml", "instrument (line 3)", "give the path of an existing file"},
    {"bad_missing_density.yaml", "instrument.sections.0.density (line 6)", "give a number in kg/m³"},
    {"bad_missing_stiffness.yaml", "instrument.sections.0.bending_stiffness (line 6)",
     "give bending_stiffness or young_modulus"},
    {"bad_stiffness_twice.yaml", "instrument.sections.0.young_modulus (line 12)", "keep one of"},
    {"bad_negative_stiffness.yaml", "instrument.sections.0.bending_stiffness (line 10)", "must be positive"},
    {"bad_zero_radius.yaml", "instrument.sections.0.radius (line 7)", "must be positive in m"},
    {"bad_incompressible_beyond.yaml", "instrument.sections.0.poisson_ratio (line 11)", "at most 0.5"},
    {"bad_unit_in_value.yaml", "instrument.sections.0.radius (line 7)", "without the unit"},
    {"bad_text_for_number.yaml", "duration (line 2)", "expected a number in s"},
    {"bad_not_a_number.yaml", "duration (line 2)", "finite number"},
    {"bad_insertion_without_introducer.yaml", "drive.speed (line 14)", "set introducer: true"},
    {"bad_rotation_without_clamp.yaml", "proximal_end (line 1)", "set proximal_end: clamped"},
    {"bad_distal_hold_missing.yaml", "distal_end.hold (line 13)", "one of free, pinned, clamped"},
    {"bad_distal_twist_of_a_pin.yaml", "distal_end.twist (line 15)", "set hold: clamped"},
    {"bad_distal_moved_but_free.yaml", "distal_end.displacement (line 15)", "set hold: pinned"},
    {"bad_distal_tilt_of_a_pin.yaml", "distal_end.tilt (line 15)", "set hold: clamped"},
    {"bad_distal_tilt_without_axis.yaml", "distal_end.tilt.axis (line 15)", "give the axis"},
    {"bad_distal_turned_but_free.yaml", "distal_end.rotation (line 15)", "twist: held"},
    {"bad_distal_moved_at_the_start.yaml", "distal_end.displacement (line 15)", "[0, 0]"},
    {"bad_distal_stretches_the_wire.yaml", "distal_end.displacement (line 15)", "no further apart"},
    {"bad_distal_shortened_without_side.yaml", "distal_end.displacement (line 15)", "add loads.gravity"},
    {"bad_distal_torque_on_a_held_twist.yaml", "loads.point_loads.0.torque (line 18)", "distal_end.twist: free"},
    {"bad_distal_held_behind_an_introducer.yaml", "distal_end (line 13)", "solver.scheme: kkt"},
    {"bad_offset_of_a_pose.yaml", "entry.offset (line 13)", "move position"},
    {"bad_infinite_duration.yaml", "duration (line 2)", "must be positive"},
    {"bad_tip_longer_than_wire.yaml", "instrument.tip (line 12)", "shorten the tip"},
    {"bad_tip_and_rest_curvature.yaml", "instrument.tip (line 13)", "give either tip or"},
    {"bad_straight_tip_with_angle.yaml", "instrument.tip.angle (line 14)", "remove it"},
    {"bad_unknown_tip_shape.yaml", "instrument.tip.shape (line 13)", "one of straight, angled, semicircle, j"},
    {"bad_rest_curvature_too_tight.yaml", "instrument.sections.0.rest_curvature (line 12)", "less than 1/radius"},
    {"bad_unknown_material.yaml", "instrument.sections.0.material (line 8)",
     "one of nitinol, steel, platinum, polymer, filled_polymer"},
    {"bad_name_with_a_slash.yaml", "instrument.name (line 4)", "letters, digits and _"},
    {"bad_profile_times_do_not_increase.yaml", "drive.insertion.points (line 15)", "increasing"},
    {"bad_profile_row_of_three.yaml", "drive.insertion.points.0 (line 15)", "a list of 2 numbers"},
    {"bad_sine_without_frequency.yaml", "drive.rotation.frequency (line 14)", "frequency in Hz"},
    {"bad_pressure_without_balloon.yaml", "drive.pressure (line 14)", "use a balloon_catheter"},
    {"bad_pressure_below_vacuum.yaml", "drive.pressure (line 5)", "at least -101325 Pa"},
    {"bad_speed_without_travel.yaml", "drive.travel (line 12)", "give a number in m"},
    {"bad_speed_and_profile.yaml", "drive.insertion (line 16)", "keep one of the two"},
    {"bad_motion_without_source.yaml", "drive.source (line 12)", "set source: script"},
    {"bad_pushed_beyond_its_length.yaml", "drive.travel (line 15)", "at most the wire's length"},
    {"bad_pulled_out_of_the_introducer.yaml", "drive.insertion (line 14)", "zero or positive"},
    {"bad_device_without_device.yaml", "drive.source (line 13)", "set haptic_device: true"},
    {"bad_clamped_in_an_introducer.yaml", "proximal_end (line 13)", "introducer: false"},
    {"bad_zero_time_step.yaml", "solver.time_step (line 13)", "greater than 0"},
    {"bad_two_nodes.yaml", "sampling.nodes (line 13)", "between 3 and"},
    {"bad_fractional_nodes.yaml", "sampling.nodes (line 13)", "whole number"},
    {"bad_sampling_kind.yaml", "sampling.kind (line 13)", "must be one of uniform, adaptive"},
    {"bad_nodes_of_adaptive_sampling.yaml", "sampling.nodes (line 14)", "belongs to uniform sampling"},
    {"bad_edges_of_uniform_sampling.yaml", "sampling.min_edge (line 13)", "belongs to adaptive sampling"},
    {"bad_max_edge.yaml", "sampling.max_edge (line 14)", "less than min_edge"},
    {"bad_tiny_min_edge.yaml", "sampling.min_edge (line 14)", "more than 100000 nodes"},
    {"bad_too_few_nodes_for_the_guide.yaml", "sampling.nodes (line 13)", "at least 23"},
    {"bad_max_edge_for_the_guide.yaml", "sampling.max_edge (line 14)", "at most half of solver.guide_length"},
    {"bad_min_edge_of_a_fast_hand.yaml", "sampling.min_edge (line 14)", "at least 4 times"},
    {"bad_duplicate_key.yaml", "duration (line 3)", "keep one of the two"},
    {"bad_broken_yaml.yaml", "line 13", "not valid YAML"},
    {"bad_empty_file.yaml", "line 1", "expected `key: value` lines"},
    {"bad_list_at_the_root.yaml", "line 1", "expected `key: value` lines"},
    {"bad_anchor_in_itself.yaml", "loads (line 13)", "anchor"},
    {"bad_mesh_without_unit.yaml", "vessel.unit (line 12)", "metres per unit"},
    {"bad_missing_mesh.yaml", "vessel.mesh (line 13)", "give the path of an existing file"},
    {"bad_no_vessel_kind.yaml", "vessel (line 12)", "exactly one of mesh, anatomy, tube"},
    {"bad_mesh_and_tube.yaml", "vessel.mesh (line 13)", "exactly one of"},
    {"bad_unit_of_a_tube.yaml", "vessel.unit (line 13)", "remove it"},
    {"bad_skewed_rotation.yaml", "vessel.rotation (line 15)", "unit vectors at right angles"},
    {"bad_head_along_left.yaml", "vessel.left (line 16)", "right angles to head"},
    {"bad_entry_missing.yaml", "entry.position (line 1)", "give position and direction"},
    {"bad_entry_end_without_vessel.yaml", "entry.centreline_end (line 13)", "give position and direction"},
    {"bad_entry_direction_zero.yaml", "entry.direction (line 13)", "give a direction"},
    {"bad_entry_up_along_direction.yaml", "entry.up (line 14)", "across the wire"},
    {"bad_tube_narrower_than_wire.yaml", "vessel.tube.radius (line 14)", "must be greater than"},
    {"bad_tube_bend_too_tight.yaml", "vessel.tube.pieces.0.curvature (line 14)", "less than 1/radius"},
    {"bad_friction_word.yaml", "vessel.friction (line 13)", "one of hydrophilic, ptfe, bare"},
    {"bad_wall_word.yaml", "vessel.wall (line 13)", "one of facets, smooth"},
    {"bad_smooth_wall_of_a_balloon.yaml", "vessel.wall (line 5)", "a balloon moves the wall"},
    {"bad_friction_region.yaml", "vessel.friction_regions.0.radius (line 14)", "must be positive"},
    {"bad_friction_region_without_friction.yaml", "vessel.friction_regions.0.friction (line 14)", "give a number"},
    {"bad_lesion_closed.yaml", "vessel.lesions.0.grade (line 14)", "between 0 and 0.99"},
    {"bad_wire_in_millimetres.yaml", "instrument.sections.0.radius (line 7)", "did you mean 0.2286 mm = 0.0002286 m?"},
    {"bad_lesion_placed_twice.yaml", "vessel.lesions.0.fraction (line 14)", "keep one of the two"},
    {"bad_lesion_at_a_point_and_on_a_branch.yaml", "vessel.lesions.0.branch (line 14)", "conflicts with at"},
    {"bad_load_beyond_the_tip.yaml", "loads.point_loads.0.position (line 14)", "at most the wire's length"},
    {"bad_torque_inside_the_wire.yaml", "loads.point_loads.0.torque (line 14)", "remove position"},
    {"bad_patient_behind_detector.yaml", "fluoroscopy.source_to_patient (line 13)", "less than source_to_detector"},
    {"bad_energy_outside_the_table.yaml", "fluoroscopy.energy (line 13)", "between 30 and 100"},
    {"bad_yes_for_true.yaml", "haptic_device (line 12)", "true or false"},
    {"bad_negative_wall_force_threshold.yaml", "record.wall_force_threshold (line 13)", "zero or positive"},
    {"bad_negative_seed.yaml", "seed (line 3)", "zero or positive"},
};

std::string refusalOf(const std::string& file, const std::vector<std::string>& overrides = {})
{
  return inputErrorOf([&] { loadScene(file, overrides); });
}

bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

TEST(SceneRefusals, ReportFileKeyLineAndRemedy)
{
  for (const Refusal& refusal : kRefusals)
  {
    const std::string message = refusalOf(kFolder + refusal.file);
    EXPECT_TRUE(contains(message, kFolder + refusal.file + ": " + refusal.location + ": ")) << refusal.file << "\n"
                                                                                            << message;
    EXPECT_TRUE(contains(message, refusal.remedy)) << refusal.file << "\n" << message;
  }
}

TEST(SceneRefusals, CoverAllInvalidScenesOfTheTestData)
{
  std::set<std::string> listed;
  for (const Refusal& refusal : kRefusals)
    listed.insert(refusal.file);
  std::set<std::string> present;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder))
    if (entry.path().filename().string().rfind("bad_", 0) == 0)
      present.insert(entry.path().filename().string());
  EXPECT_EQ(listed, present);
  EXPECT_GE(present.size(), 20U);
}

TEST(SceneRefusals, AcceptAValidScene)
{
  EXPECT_EQ(refusalOf(kFolder + "good_bench.yaml"), "");
}

TEST(SceneRefusals, ReportAMissingSceneFile)
{
  EXPECT_TRUE(contains(refusalOf(kFolder + "absent.yaml"), "absent.yaml: no such file"));
  EXPECT_TRUE(contains(refusalOf(kFolder), "is not a file"));
}

TEST(SceneRefusals, ApplyToOverrides)
{
  const std::string file = kFolder + "good_bench.yaml";
  EXPECT_TRUE(contains(refusalOf(file, {"durration=1"}), "durration (--set): unknown key; did you mean \"duration\"?"));
  EXPECT_TRUE(contains(refusalOf(file, {"drive.sped=1"}), "drive.sped (--set): unknown key; did you mean \"speed\"?"));
  EXPECT_TRUE(contains(refusalOf(file, {"solver.time_step=-1"}), "solver.time_step (--set): is -1; must be"));
  EXPECT_TRUE(contains(refusalOf(file, {"instrument.sections.1.radius=1"}), "counted from 0"));
  EXPECT_TRUE(contains(refusalOf(file, {"duration.seconds=1"}), "which has no keys"));
  EXPECT_TRUE(contains(refusalOf(file, {"duration"}), "expected key.path=value"));
  EXPECT_TRUE(contains(refusalOf(file, {"loads.gravity=[0, 0"}), "not valid YAML"));
}

TEST(SceneRefusals, ReportTheFileOfTheInstrument)
{
  const std::string message = refusalOf(std::string(PROJECT_DIR) + "/config/scenes/straight_wire.yaml",
                                        {"instrument=" + kFolder + "wire_without_length.yaml"});
  EXPECT_TRUE(contains(message, "wire_without_length.yaml: instrument.sections.0.length (line 3): missing; give"))
      << message;
}

}  // namespace
}  // namespace endovascular_sim::scene
