#include "rviz_plugin/widget/view_rows.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>

#include "rviz_plugin/model/session_port.h"
#include "rviz_plugin/widget/panel_parts.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

const char* const kViews[] = {"AP",        "LAO 40", "RAO 30", "RAO 30 CAU 20", "LAO 40 CRA 20",
                              "AP CRA 30", "spider", "lateral"};

}  // namespace

CArmRow::CArmRow(SessionPort& port, QWidget& keys) : views_(new QComboBox)
{
  auto* layout = compact(new QHBoxLayout(this));
  layout->addWidget(new QLabel("C-arm"));
  views_->setObjectName("views");
  views_->setEditable(true);
  views_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  for (const char* view : kViews)
    views_->addItem(view);
  const auto move = [this, &port, &keys]
  {
    port.moveCArm(views_->currentText().toStdString());
    keys.setFocus();
  };
  connect(views_, QOverload<int>::of(&QComboBox::activated), views_, move);
  layout->addWidget(views_, 1);
  layout->addWidget(panelButton("Move", "move_c_arm", move));
}

void CArmRow::showView(const std::string& view)
{
  if (view == shown_ || views_->hasFocus() || (view.empty() && isEnabled()))
    return;
  shown_ = view;
  views_->setCurrentText(view.empty() ? QString("view of the scene") : QString::fromStdString(view));
}

QWidget* makeViewRow(QWidget& keys, const std::function<void(const QString&)>& choose)
{
  auto* row = new QWidget;
  auto* layout = compact(new QHBoxLayout(row));
  layout->addWidget(new QLabel("View"));
  const struct
  {
    const char *text, *view;
  } views[] = {{"Overview", "Overview"}, {"Tip", "Tip"}, {"In vessel", "AlongVessel"}};
  for (const auto& choice : views)
    layout->addWidget(panelButton(choice.text, QString("view_") + choice.view,
                                  [&keys, choose, view = QString(choice.view)]
                                  {
                                    keys.setFocus();
                                    choose(view);
                                  }),
                      1);
  return row;
}

}  // namespace endovascular_sim::rviz_plugin
