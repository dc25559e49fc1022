#include "common/version.h"

#include "endovascular_sim_commit.h"

namespace endovascular_sim
{

const char* version()
{
  return ENDOVASCULAR_SIM_VERSION;
}

const char* commit()
{
  return ENDOVASCULAR_SIM_COMMIT;
}

}  // namespace endovascular_sim
