#include "rviz_plugin/widget/expert_row.h"

#include <cmath>

#include <QAbstractItemView>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>

#include "common/text/format.h"
#include "rviz_plugin/widget/panel_parts.h"

namespace endovascular_sim::rviz_plugin
{

ExpertRow::ExpertRow(SessionPort& port, QWidget& keys)
  : alignments_(new QComboBox), distance_(panelLabel("tip_distance"))
{
  auto* layout = compact(new QHBoxLayout(this));
  layout->addWidget(new QLabel("Expert"));
  alignments_->setObjectName("expert_alignments");
  alignments_->setFocusPolicy(Qt::NoFocus);
  alignments_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  // In the order of ExpertState.
  for (const char* text : {"hidden", "since the start", "step by step", "by insertion", "alone"})
    alignments_->addItem(text);
  connect(alignments_, QOverload<int>::of(&QComboBox::activated), alignments_,
          [&port, &keys](int alignment)
          {
            port.alignExpert(static_cast<std::uint8_t>(alignment));
            keys.setFocus();
          });
  layout->addWidget(alignments_, 1);
  layout->addWidget(distance_, 1);
}

void ExpertRow::showState(const ExpertState& state)
{
  if (state.alignment < alignments_->count() && !alignments_->view()->isVisible())
    alignments_->setCurrentIndex(state.alignment);
  alignments_->setToolTip(QString::fromStdString(state.name));
  const bool is_known = std::isfinite(state.distance);
  distance_->setText(is_known ? QString::fromStdString(formatted("tips %.1f mm apart", 1e3 * state.distance)) : "");
}

}  // namespace endovascular_sim::rviz_plugin
