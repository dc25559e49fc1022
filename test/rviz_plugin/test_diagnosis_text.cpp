#include "rviz_plugin/model/diagnosis_text.h"

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

using diagnostic_msgs::DiagnosticStatus;

DiagnosticStatus status(const std::string& name, const std::string& message,
                        std::uint8_t level = DiagnosticStatus::WARN)
{
  DiagnosticStatus status;
  status.name = name;
  status.message = message;
  status.level = level;
  return status;
}

/** Warning of late steps. @param on_time share of the others [%] */
DiagnosticStatus lateSteps(const std::string& on_time)
{
  DiagnosticStatus late = status("rod_dynamics: simulation", "more than 1 % of the steps are late");
  late.values.resize(1);
  late.values[0].key = "on time [%]";
  late.values[0].value = on_time;
  return late;
}

TEST(DiagnosisText, ShowsEveryWarningOutsideOfALesson)
{
  EXPECT_EQ(diagnosisText(lateSteps("97.5"), false), "rod_dynamics: simulation: more than 1 % of the steps are late");
  EXPECT_EQ(diagnosisText(status("contact", "no vessel", DiagnosticStatus::ERROR), false), "contact: no vessel");
  EXPECT_EQ(diagnosisText(status("contact", "running", DiagnosticStatus::OK), false), "");
}

TEST(DiagnosisText, ALessonNamesLateStepsInWordsOnlyIfTheyMatter)
{
  EXPECT_EQ(diagnosisText(lateSteps("97.5"), true), "");
  EXPECT_EQ(diagnosisText(lateSteps("82.1"), true), "this computer is too slow: the simulation lags behind real time");
  EXPECT_EQ(diagnosisText(status("rod_dynamics: simulation", "scheduling: no real time"), true), "");
  EXPECT_EQ(diagnosisText(status("rod_dynamics: simulation", "paused: by a client"), true),
            "rod_dynamics: simulation: paused: by a client");
}

TEST(DiagnosisText, ALessonShowsErrorsAndOtherWarnings)
{
  EXPECT_EQ(diagnosisText(status("/instruments/wire", "the grip slips"), true), "") << "the notice says it";
  EXPECT_EQ(diagnosisText(status("/instruments/wire", "fault", DiagnosticStatus::ERROR), true),
            "/instruments/wire: fault");
  EXPECT_EQ(diagnosisText(status("session", "the disk is full"), true), "session: the disk is full");
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
