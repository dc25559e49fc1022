#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include <pybind11/pybind11.h>

#include "commands.h"
#include "session/session.h"
#include "world.h"
#include "zeroed.h"

namespace endovascular_sim::python
{

/** Session as Python sees it. Each use is exclusive: a second thread, and a use after close(), raise UsageError. */
class OwnedSession : public Zeroed
{
public:
  OwnedSession(std::shared_ptr<SharedWorld> world, std::uint64_t seed, bool results, bool clients);

  /** Exclusive use of the session while it lives; made and destroyed with the GIL. */
  class Use
  {
  public:
    /** @throws UsageError if the session is closed or in use */
    explicit Use(OwnedSession& owner);
    ~Use() { owner_.in_use_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

    session::Session& operator*() const { return *owner_.session_; }
    session::Session* operator->() const { return owner_.session_.get(); }

  private:
    OwnedSession& owner_;
  };

  /** Ends the session; a second call has no effect. @throws UsageError if the session is in use */
  void close();

  bool isClosed() const { return session_ == nullptr; }

  const std::shared_ptr<SharedWorld>& world() const { return world_; }
  bool gathersResults() const { return results_; }
  bool hasClients() const { return clients_; }

private:
  std::shared_ptr<SharedWorld> world_;
  bool results_;
  bool clients_;
  std::unique_ptr<session::Session> session_;  ///< null after close()
  std::atomic<bool> in_use_{false};
};

void bindSession(pybind11::module_& module);

}  // namespace endovascular_sim::python
