#include "session/phase_pictures.h"

#include "common/output_file.h"
#include "common/text/format.h"
#include "fluoroscopy/image/png_writer.h"

namespace endovascular_sim::session
{

PhasePictures::PhasePictures(const World& world, const std::string& folder)
  : image_(world), folder_(folder + "/fluoroscopy")
{
  createFolder(folder_);
}

void PhasePictures::update(const Session& session)
{
  const procedure::Operator& scripted = *session.scriptedOperator();
  if (finished_ || scripted.records().empty())
    return;
  const procedure::StepRecord& step = scripted.records().back();
  finished_ = scripted.progress() != procedure::Progress::kRunning;
  if (finished_)
    view_ = step.view;
  if (finished_ || (!phase_.empty() && step.phase != phase_))
    writeImage(session);
  phase_ = step.phase;
  view_ = step.view;
}

void PhasePictures::writeImage(const Session& session)
{
  image_.setView(view_);
  const std::string name = formatted("/phase_%02d.png", ++images_);
  const fluoroscopy::Frame& frame = image_.frame(session.simulation(), &session.wall());
  fluoroscopy::writePng(folder_ + name, frame.pixels, frame.pixels, frame.image);
}

}  // namespace endovascular_sim::session
