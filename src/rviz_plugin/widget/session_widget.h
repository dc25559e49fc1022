#pragma once

#include <optional>
#include <string>

#include <QElapsedTimer>
#include <QPointer>
#include <QTimer>
#include <QWidget>

#include "rviz_plugin/model/joystick.h"
#include "rviz_plugin/model/session_port.h"

class QLabel;

namespace endovascular_sim::rviz_plugin
{

class CArmRow;
class ContrastBox;
class DriveBox;
class ExpertRow;
class MotionBox;
class PlayerRow;
class PressureBox;
class SessionRow;
class StateBox;
class SubjectRow;
class VerdictDialog;

/** Widget of the panel: controls of a session and its state. Independent of rviz and of ROS's connections.
 *
 *  Keys, while the widget or the widget of takeKeysOf() has the focus: up and down push and pull, left and right twist,
 * space pauses and starts, page up and down choose an instrument. Loss of the focus ends all motions. A gamepad acts
 * without the focus: its sticks push and twist, button 0 (A) pauses and starts, 1 (B) chooses the next instrument, 3
 * (Y) and 2 (X) inflate and deflate the balloon.
 *
 *  While a recording is played, the row of its player stands in place of the controls that drive, and has the keys. */
class SessionWidget : public QWidget
{
  Q_OBJECT

public:
  /** @param port outlives the widget
   *  @param joystick device of a gamepad; it need not exist */
  explicit SessionWidget(SessionPort& port, QWidget* parent = nullptr, const std::string& joystick = "/dev/input/js0");
  ~SessionWidget() override;

  int speedSetting() const;           ///< position of the speed slider, 0 to 100
  void setSpeedSetting(int setting);  ///< as speedSetting()

  /** Also takes the keys of another widget, such as the picture of the scene. It keeps all other keys. */
  void takeKeysOf(QWidget& other);
  bool eventFilter(QObject* watched, QEvent* event) override;

Q_SIGNALS:
  void viewChosen(const QString& view);  ///< view of the picture: Overview, Tip or AlongVessel

public Q_SLOTS:    // NOLINT(readability-redundant-access-specifiers): after signals
  void refresh();  ///< takes over the state of the session; a timer calls it

protected:
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  void hideEvent(QHideEvent* event) override;

private:
  bool takesKeys() const;
  bool pressKey(const QKeyEvent& event);    ///< @return false for a key without a meaning
  bool releaseKey(const QKeyEvent& event);  ///< as pressKey()
  void pauseOrStart();
  void followJoystick();
  void followProcedure();  ///< chooses the instrument of a new step
  void showNotice();
  void endLesson();
  void showPlayer();
  void showPatient();  ///< blood, heart and breath, contrast medium

  SessionPort& port_;
  Joystick joystick_;
  SessionState state_;
  SessionRow* session_;
  PlayerRow* player_;
  DriveBox* drive_;
  StateBox* box_;
  PressureBox* pressure_;
  MotionBox* motion_;
  ContrastBox* contrast_;
  CArmRow* c_arm_;
  QLabel* notice_;  ///< error of the trainee, or reason why the instrument does not follow
  SubjectRow* subject_;
  ExpertRow* expert_;
  VerdictDialog* verdict_;
  bool lesson_done_ = false;  ///< the procedure of a lesson is done
  std::optional<std::size_t> followed_step_;
  std::string change_;     ///< instrument that the procedure chose last
  QElapsedTimer changed_;  ///< since then; invalid before
  QTimer timer_;
  QPointer<QWidget> key_source_;  ///< see takeKeysOf(); null without one
};

}  // namespace endovascular_sim::rviz_plugin
