#include "rviz_plugin/widget/verdict_dialog.h"

#include <cmath>

#include <QDesktopServices>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTableWidget>
#include <QUrl>
#include <QVBoxLayout>

#include "common/text/format.h"
#include "rviz_plugin/widget/font_scale.h"
#include "rviz_plugin/widget/panel_parts.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

enum Column
{
  kName,
  kValue,
  kLimit,
  kExpert,
  kColumns,
};

constexpr int kRim = 12;     // between the dialog and the edge of the window [pixels]
constexpr int kDigits = 56;  // width of the dialog

/** Value with its unit; a dash for an unknown one. */
QString text(double value, const std::string& unit)
{
  if (!std::isfinite(value))
    return "–";
  const std::string number = formatted(unit == "N" ? "%.2f" : unit.empty() ? "%.0f" : "%.1f", value);
  return QString::fromStdString(unit.empty() ? number : number + " " + unit);
}

}  // namespace

VerdictDialog::VerdictDialog(SessionPort& port, QWidget& keys) : QDialog(&keys), port_(port), keys_(keys)
{
  setObjectName("verdict_dialog");
  setWindowTitle("Lesson");
  setFont(scaledFont(font()));  // a window does not take the font of its parent
  auto* layout = new QVBoxLayout(this);
  text_ = new QLabel;
  text_->setObjectName("verdict");
  text_->setFont(scaledFont(text_->font()));
  text_->setWordWrap(true);
  text_->setTextFormat(Qt::PlainText);
  layout->addWidget(text_);
  marks_ = new QTableWidget(0, kColumns);
  marks_->setObjectName("marks");
  marks_->setHorizontalHeaderLabels({"", "you", "at most", "expert"});
  marks_->verticalHeader()->hide();
  marks_->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  marks_->horizontalHeader()->setSectionResizeMode(kName, QHeaderView::Stretch);
  marks_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  marks_->setSelectionMode(QAbstractItemView::NoSelection);
  marks_->setFocusPolicy(Qt::NoFocus);
  layout->addWidget(marks_);
  auto* row = new QHBoxLayout;
  row->addWidget(panelButton("Open the page", "open_page", [this] { openPage(); }));
  row->addWidget(panelButton("Try again", "try_again", [this] { finishWith(Request::kReset); }));
  auto* show_me = panelButton("Show me", "show_me", [this] { finishWith(Request::kShowExpert); });
  show_me->setToolTip("Plays the recording of the expert");
  row->addWidget(show_me);
  auto* close = panelButton("Close", "close_verdict", [this] { reject(); });
  close->setDefault(true);  // of the return key
  row->addWidget(close);
  layout->addLayout(row);
  connect(this, &QDialog::finished, this, [this] { keys_.setFocus(); });
}

void VerdictDialog::present(const Verdict& verdict)
{
  if (verdict.run == 0 || (verdict.run == verdict_.run && verdict.page == verdict_.page))
    return;
  verdict_ = verdict;
  fill(verdict);
  const QRect window = keys_.window()->geometry();  // at its right edge: vessel and panel remain visible
  move(window.right() - width() - kRim, window.center().y() - height() / 2);
  show();
  raise();
}

void VerdictDialog::fill(const Verdict& verdict)
{
  text_->setText(QString::fromStdString(verdict.text));
  text_->setStyleSheet(QString("font-weight: bold; color: %1").arg(verdict.passed ? "#1d7a35" : "#c62f2f"));
  marks_->setRowCount(static_cast<int>(verdict.marks.size()));
  for (int row = 0; row < marks_->rowCount(); ++row)
  {
    const VerdictMark& mark = verdict.marks[static_cast<std::size_t>(row)];
    const QString cells[kColumns] = {QString::fromStdString(mark.name), text(mark.value, mark.unit),
                                     text(mark.limit, mark.unit), text(mark.expert, mark.unit)};
    for (int column = 0; column < kColumns; ++column)
    {
      auto* item = new QTableWidgetItem(cells[column]);
      if (column != kName)
        item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
      if (column == kValue)
        item->setForeground(QColor(mark.passed ? "#1d7a35" : "#c62f2f"));
      marks_->setItem(row, column, item);
    }
  }
  marks_->resizeRowsToContents();
  int height = marks_->horizontalHeader()->sizeHint().height() + 4;
  for (int row = 0; row < marks_->rowCount(); ++row)
    height += marks_->rowHeight(row);
  marks_->setFixedHeight(height);
  setMinimumWidth(marks_->fontMetrics().horizontalAdvance('0') * kDigits);
  adjustSize();
}

void VerdictDialog::finishWith(Request request)
{
  port_.request(request);
  accept();
}

void VerdictDialog::openPage() const
{
  QDesktopServices::openUrl(QUrl::fromLocalFile(QString::fromStdString(verdict_.page)));
}

}  // namespace endovascular_sim::rviz_plugin
