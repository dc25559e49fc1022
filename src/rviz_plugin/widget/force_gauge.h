#pragma once

#include <QProgressBar>

namespace endovascular_sim::rviz_plugin
{

/** Gauge of a force as a share of its limit, with a mark above and below its text at the largest share so far. */
class ForceGauge : public QProgressBar
{
public:
  ForceGauge();

  /** @param share, peak of the limit [%], 0 to 100 */
  void showForce(int share, int peak);
  int peak() const { return peak_; }

protected:
  void paintEvent(QPaintEvent* event) override;

private:
  int peak_ = 0;
};

}  // namespace endovascular_sim::rviz_plugin
