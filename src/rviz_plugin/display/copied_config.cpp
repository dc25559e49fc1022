#include "rviz_plugin/display/copied_config.h"

#include <cstdlib>

#include <rviz/display_context.h>
#include <rviz/window_manager_interface.h>
#include <QEvent>
#include <QWidget>

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr auto kName = "endovascular_sim_closing";

/** Marks a window as saved when it closes. */
class ClosingWindow : public QObject
{
public:
  explicit ClosingWindow(QWidget& window) : QObject(&window)
  {
    setObjectName(kName);
    window.installEventFilter(this);
  }

  bool eventFilter(QObject* watched, QEvent* event) override
  {
    if (event->type() == QEvent::Close && watched == parent())
      static_cast<QWidget*>(watched)->setWindowModified(false);
    return false;
  }
};

}  // namespace

void closeWithoutQuestion(const rviz::DisplayContext& context)
{
  rviz::WindowManagerInterface* manager = context.getWindowManager();
  QWidget* window = manager != nullptr ? manager->getParentWindow() : nullptr;
  if (std::getenv("ENDOVASCULAR_RVIZ_COPY") == nullptr || window == nullptr)
    return;
  window = window->window();
  if (window->findChild<QObject*>(kName, Qt::FindDirectChildrenOnly) == nullptr)
    new ClosingWindow(*window);  // owned by the window
}

}  // namespace endovascular_sim::rviz_plugin
