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

QWidget* makeCArmRow(SessionPort& port, QWidget& keys)
{
  auto* row = new QWidget;
  auto* layout = compact(new QHBoxLayout(row));
  layout->addWidget(new QLabel("C-arm"));
  auto* views = new QComboBox;
  views->setObjectName("views");
  views->setEditable(true);
  for (const char* view : kViews)
    views->addItem(view);
  const auto move = [&port, &keys, views]
  {
    port.moveCArm(views->currentText().toStdString());
    keys.setFocus();
  };
  QObject::connect(views, QOverload<int>::of(&QComboBox::activated), views, move);
  layout->addWidget(views, 1);
  layout->addWidget(panelButton("Move", "move_c_arm", move));
  return row;
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
