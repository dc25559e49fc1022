#include "contrast/injection/injector.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "common/archive.h"
#include "common/archive_checks.h"

namespace endovascular_sim::contrast
{

void Injector::start(const Injection& injection)
{
  if (const std::string refusal = refusalOf(injection, syringe_, content_); !refusal.empty())
    throw std::invalid_argument("injection: " + refusal);
  injection_ = injection;
  elapsed_ = given_ = 0.0;
}

void Injector::stop()
{
  injection_ = Injection();
  elapsed_ = given_ = 0.0;
}

Dose Injector::advance(double time_step)
{
  if (!isActive())
    return {};
  elapsed_ += time_step;
  const double given = injection_.volumeAfter(elapsed_);
  const double volume = std::min(given - given_, content_);
  content_ -= volume;
  given_ = given;
  return {volume, injection_.concentration, injection_.viscosity};
}

void Injector::archive(Archive& archive)
{
  archive(injection_.volume, injection_.rate, injection_.rise, injection_.concentration, injection_.viscosity, content_,
          elapsed_, given_);
  if (!archive.reading())
    return;
  requireFinite(injection_.volume, injection_.rate, injection_.rise, injection_.concentration, injection_.viscosity,
                content_, elapsed_, given_);
  requireLoaded(content_ >= 0.0 && content_ <= syringe_.capacity && given_ >= 0.0 && given_ <= injection_.volume,
                "holds an injection that no syringe gives");
}

}  // namespace endovascular_sim::contrast
