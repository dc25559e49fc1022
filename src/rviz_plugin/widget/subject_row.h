#pragma once

#include <string>

#include <QWidget>

class QLineEdit;

namespace endovascular_sim::rviz_plugin
{

class SessionPort;

/** Row of the panel with the pseudonym of the trainee, which becomes part of the recording. */
class SubjectRow : public QWidget
{
public:
  /** @param port, keys as of SessionRow */
  SubjectRow(SessionPort& port, QWidget& keys);

  /** Shows the pseudonym of the recording. A text that the user is typing remains. */
  void showSubject(const std::string& subject);

private:
  QLineEdit* text_;
};

}  // namespace endovascular_sim::rviz_plugin
