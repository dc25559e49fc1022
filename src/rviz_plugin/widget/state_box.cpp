#include "rviz_plugin/widget/state_box.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <QFormLayout>
#include <QLabel>

#include "rviz_plugin/widget/force_gauge.h"
#include "rviz_plugin/widget/panel_parts.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr std::size_t kMostTexts = 3;  // of the shown errors, and of the warnings
constexpr int kHintLines = 4;          // for which there is always room: rows below do not move
constexpr int kHintRim = 4;            // [pixels]

QStringList firstTexts(const std::vector<std::string>& texts)
{
  QStringList shown;
  for (std::size_t k = 0; k < std::min(texts.size(), kMostTexts); ++k)
    shown << QString::fromStdString(texts[k]);
  if (texts.size() > kMostTexts)
    shown << QString("and %1 more").arg(texts.size() - kMostTexts);
  return shown;
}

QStringList answersOf(const SessionState& state)
{
  QStringList answers;
  for (const std::string& service : state.waiting)
    answers.append("waiting for " + QString::fromStdString(service));
  if (!state.answer.empty())
    answers.append(QString::fromStdString(state.answer));
  return answers;
}

QStringList errorsOf(const SessionState& state)
{
  QStringList errors = firstTexts(state.errors);
  if (state.dead_man_stops > 0)
    errors.prepend(QString("the window was too slow: motions stopped %1 times").arg(state.dead_man_stops));
  return errors;
}

}  // namespace

StateBox::StateBox()
{
  auto* layout = new QFormLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setVerticalSpacing(2);
  // The hint comes first: on a low screen the lower rows are cut.
  hint_ = panelLabel("hint");
  hint_->setMinimumHeight(kHintLines * hint_->fontMetrics().lineSpacing() + 2 * kHintRim);
  hint_->setAlignment(Qt::AlignTop);
  hint_->setStyleSheet(QString("background: #fff6d6; color: #4a3c00; padding: %1px").arg(kHintRim));
  hint_->setWordWrap(true);
  layout->addRow(hint_);
  gauge_ = new ForceGauge;
  layout->addRow(gauge_);
  const std::pair<const char*, QLabel**> rows[] = {
      {"Insertion", &insertion_}, {"Rotation", &rotation_}, {"Force", &force_},   {"Torque", &torque_},
      {"Branch", &branch_},       {"Time", &time_},         {"Procedure", &step_}};
  for (const auto& [text, target] : rows)
  {
    *target = panelLabel(QString(text).toLower());
    layout->addRow(text, *target);
  }
  step_->setWordWrap(true);
  const struct
  {
    const char* name;
    QLabel** target;
    const char* style;
  } texts[] = {
      {"answer", &answer_, ""}, {"errors", &errors_, "color: #c62f2f"}, {"warnings", &warnings_, "color: #606060"}};
  for (const auto& text : texts)
  {
    *text.target = panelLabel(text.name);
    (*text.target)->setWordWrap(true);
    (*text.target)->setStyleSheet(text.style);
    layout->addRow(*text.target);
  }
}

void StateBox::showState(const SessionState& state, const PanelTexts& texts)
{
  const std::pair<QLabel*, const std::string*> shown[] = {
      {insertion_, &texts.insertion}, {rotation_, &texts.rotation}, {force_, &texts.force}, {torque_, &texts.torque},
      {branch_, &texts.branch},       {time_, &texts.time},         {step_, &texts.step},   {hint_, &texts.hint}};
  for (const auto& [target, text] : shown)
    target->setText(QString::fromStdString(*text));
  hint_->setVisible(!texts.hint.empty());
  gauge_->showForce(texts.gauge, texts.peak);
  const std::pair<QLabel*, QString> messages[] = {{answer_, answersOf(state).join("\n")},
                                                  {errors_, errorsOf(state).join("\n")},
                                                  {warnings_, firstTexts(state.warnings).join("\n")}};
  for (const auto& [target, text] : messages)
  {
    target->setText(text);
    target->setVisible(!text.isEmpty());
  }
}

}  // namespace endovascular_sim::rviz_plugin
