#include <algorithm>
#include <array>
#include <istream>
#include <iterator>
#include <ostream>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "common/error.h"
#include "common/releases.h"
#include "common/version.h"
#include "scene/model/portable_text.h"
#include "simulation/saved_state.h"
#include "simulation/simulation.h"
#include "simulation/stepper_factory.h"

// File of a saved state: header, bytes of the archive, and a hash over both.

namespace endovascular_sim::simulation
{
namespace
{

constexpr std::uint32_t kNamesWriter = 5;  ///< first format whose header names the version that wrote it

/** First commits of the formats whose headers do not name the version that wrote them. */
constexpr std::array<const char*, 4> kFormatCommits = {"3dc36e6", "613f4dc", "6b5167a", "ca765d6"};

constexpr double kLargestDistalTurn = 20.0;  ///< between a saved distal end and its motion [rad]

/** Data that must agree before a state is used. The layout up to and including the writer is the same in all formats
 *  from kNamesWriter on, so that every later version can name the writer of a state that it does not load. */
struct Header
{
  std::array<char, 8> magic = kStateMagic;
  std::uint32_t format = kStateFormat;
  std::string writer = std::string(version()) + ", commit " + commit();
  int physics = kPhysicsNumber;
  std::uint64_t scene_hash = 0;
  std::uint64_t vessel_hash = 0;

  void archive(Archive& archive)
  {
    for (char& letter : magic)
      archive(letter);
    archive(format);
    if (format < kNamesWriter)
      readOldWriter();
    else
      archiveWriter(archive);
    if (format == kStateFormat)
      archive(physics, scene_hash, vessel_hash);
  }

private:
  void readOldWriter()
  {
    const bool known = format >= 1 && format <= kFormatCommits.size();
    writer = known ? std::string("0.1.0, commit ") + kFormatCommits[format - 1] + " or a later one" : "unknown";
  }

  void archiveWriter(Archive& archive)
  {
    std::vector<char> letters(writer.begin(), writer.end());
    archive(letters);
    writer.assign(letters.begin(), letters.end());
  }
};

std::uint64_t hashOf(const char* data, std::size_t size)
{
  Hash64 hash;
  hash.add(data, size);
  return hash.value();
}

/** Bytes without the hash at their end.
 *  @throws InputError when the hash does not fit */
std::string checked(std::string bytes, const std::string& origin)
{
  std::uint64_t stored = 0;
  if (!beginsAsState(bytes) || bytes.size() < kStateMagic.size() + sizeof stored)
    throw InputError(origin, "", "is not a saved state; save one with simulate --save-state");
  const std::size_t size = bytes.size() - sizeof stored;
  std::memcpy(&stored, bytes.data() + size, sizeof stored);
  if (stored != hashOf(bytes.data(), size))
    throw InputError(origin, "", "is damaged or cut off: its content does not match its hash; save it again");
  bytes.resize(size);
  return bytes;
}

/** Remedy for a state that this version does not load: the release that does, if there is one. */
std::string loadItElsewhere(std::uint32_t format, int physics)
{
  const std::string release = releaseOfState(format, physics);
  return "; load it with " + (release.empty() ? "the version that wrote it" : release) + ", or save it again";
}

/** @param former_hash of the scene, as states of former versions hold it
 *  @param of_same_scene false: accepts the state of another scene */
void checkHeader(const Header& header, const Header& wanted, std::uint64_t former_hash, const std::string& origin,
                 bool of_same_scene)
{
  if (header.format != kStateFormat)
    throw InputError(origin, "",
                     "has format " + std::to_string(header.format) + ", written by endovascular_sim " + header.writer +
                         "; this version reads format " + std::to_string(kStateFormat) +
                         loadItElsewhere(header.format, 0));  // the layout behind the writer is another one
  if (header.physics != wanted.physics)
    throw InputError(origin, "",
                     "was saved with physics number " + std::to_string(header.physics) + " by endovascular_sim " +
                         header.writer + "; this version has number " + std::to_string(wanted.physics) +
                         loadItElsewhere(header.format, header.physics));
  if (of_same_scene && header.scene_hash != wanted.scene_hash && header.scene_hash != former_hash)
    throw InputError(origin, "",
                     "was saved in another scene, or with other values (hash " + Hash64::toHex(header.scene_hash) +
                         ", this one's is " + Hash64::toHex(wanted.scene_hash) +
                         "); load it with the scene it was saved in");
  if (header.vessel_hash != wanted.vessel_hash)
    throw InputError(origin, "", "was saved in another vessel: the scene's mesh has changed since");
}

}  // namespace

void Simulation::archive(Archive& archive)
{
  std::uint64_t trajectory = trajectory_.value();
  archive(steps_, trajectory, state_hash_, pressures_, samples_);
  if (archive.reading())
  {
    requireLength(hands_.size(), pressures_);
    requireFinite(pressures_);
  }
  for (Handle& hand : hands_)
    archive(hand);
  trajectory_.resume(trajectory);
  if (samples_ && !sampling_)
    throw ArchiveError("has adaptive sampling, which the scene has not");
  if (sampling_)
  {
    archive(*sampling_);
    if (archive.reading())
      stepper_->resample(sampling_->discretisation());
  }
  archive(state_);
  if (archive.reading())
  {
    requireFit();
    placeRollers(time());
  }
  stepper_->archive(archive, state_);
  archive(treatments_);
  if (blood_)
    archive(*blood_);
  if (contrast_)
    archive(*contrast_);
  if (motion_)
    archive(*motion_);
  positions_at_rest_.clear();
}

/** Checks the state against the wire and the scene. A distal end far from its motion would take very many sub-steps. */
void Simulation::requireFit() const
{
  rod::requireFit(state_, discretisation().nodes(), instruments() > 1 ? instruments() : 0);
  const rod::EndMotion wanted = distalMotionAt(time());
  const double travel = (wanted.displacement - state_.distal.displacement).norm();
  const double turn =
      std::max(std::abs(wanted.rotation - state_.distal.rotation), (wanted.tilt - state_.distal.tilt).norm());
  requireLoaded(travel <= discretisation().length() && turn <= kLargestDistalTurn,
                "holds a distal end that is far from its motion");
}

void Simulation::save(std::ostream& stream, std::uint64_t vessel_hash, const std::function<void(Archive&)>& more)
{
  if (!scene_.solver.traits().saves)
    throw InputError(scene_.file, "solver.scheme", "'" + scene_.solver.scheme + "' cannot be saved; use kkt");
  Archive out;
  Header header;
  header.scene_hash = scene_.motionHash();
  header.vessel_hash = vessel_hash;
  out(header);
  archive(out);
  if (more)
    more(out);
  const std::string& bytes = out.bytes();
  const std::uint64_t hash = hashOf(bytes.data(), bytes.size());
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.write(reinterpret_cast<const char*>(&hash), sizeof hash);
}

void Simulation::load(std::istream& stream, std::uint64_t vessel_hash, const std::string& origin,
                      const std::function<void(Archive&)>& more)
{
  read(stream, vessel_hash, origin, true, more);
}

bool Simulation::adopt(std::istream& stream, std::uint64_t vessel_hash, const std::string& origin)
{
  bool has_more = false;
  read(stream, vessel_hash, origin, false,
       [&has_more](Archive& archive)
       {
         has_more = !archive.atEnd();
         archive.skipRest();
       });
  stepper_->invalidateContacts();
  return has_more;
}

/** @param of_same_scene false: accepts the state of another scene */
void Simulation::read(std::istream& stream, std::uint64_t vessel_hash, const std::string& origin, bool of_same_scene,
                      const std::function<void(Archive&)>& more)
{
  if (!scene_.solver.traits().saves)
    throw InputError(scene_.file, "solver.scheme", "'" + scene_.solver.scheme + "' cannot be loaded; use kkt");
  Archive in(checked({std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()}, origin));
  Header header;
  Header wanted;
  wanted.scene_hash = scene_.motionHash();
  wanted.vessel_hash = vessel_hash;
  try
  {
    in(header);
    checkHeader(header, wanted, scene::formerMotionHash(scene_), origin, of_same_scene);
    stepper_ = makeStepper(scene_, entry_, initial_nodes_);  // resets all members that are not saved
    if (observer_ != nullptr)
      stepper_->setObserver(observer_);
    report_ = rod::StepReport();
    archive(in);
    if (more)
      more(in);
  }
  catch (const ArchiveError& error)
  {
    throw InputError(origin, "",
                     std::string(error.what()) +
                         (of_same_scene ? "; save it again" : "; only a scene with equal instruments and nodes fits"));
  }
  if (!in.atEnd())
    throw InputError(origin, "", "holds more than a state; save it again");
}

}  // namespace endovascular_sim::simulation
