#pragma once

#include <string>
#include <utility>

#include "common/error.h"

namespace endovascular_sim
{

/** Message of the InputError that a call throws; empty if it throws none. */
template <typename Call>
std::string inputErrorOf(Call&& call)
{
  try
  {
    std::forward<Call>(call)();
  }
  catch (const InputError& error)
  {
    return error.what();
  }
  return "";
}

}  // namespace endovascular_sim
