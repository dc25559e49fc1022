#include <algorithm>
#include <array>
#include <istream>
#include <iterator>
#include <ostream>

#include "common/archive.h"
#include "common/error.h"
#include "simulation/simulation.h"

// A simulation's state in a file: a head, the bytes of the archive, and a hash over both.

namespace endovascular_sim::simulation
{
namespace
{

constexpr std::array<char, 8> kMagic = {'E', 'V', 'S', 'S', 'T', 'A', 'T', 'E'};
constexpr std::uint32_t kFormat = 4;  ///< to be counted up with every change of what is saved

/** What must agree before a state is used. */
struct Head
{
  std::array<char, 8> magic = kMagic;
  std::uint32_t format = kFormat;
  std::uint64_t scene_hash = 0;
  std::uint64_t vessel_hash = 0;

  void archive(Archive& archive)
  {
    for (char& letter : magic)
      archive(letter);
    archive(format, scene_hash, vessel_hash);
  }
};

std::uint64_t hashOf(const char* data, std::size_t size)
{
  Hash64 hash;
  hash.add(data, size);
  return hash.value();
}

/** The text without the hash at its end, which must be right. */
std::string checked(std::string bytes, const std::string& origin)
{
  std::uint64_t told = 0;
  const bool magic = bytes.size() > kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
  if (!magic || bytes.size() < kMagic.size() + sizeof told)
    throw InputError(origin, "", "is not a saved state; save one with simulate --save-state");
  const std::size_t size = bytes.size() - sizeof told;
  std::memcpy(&told, bytes.data() + size, sizeof told);
  if (told != hashOf(bytes.data(), size))
    throw InputError(origin, "", "is damaged or cut off: its content does not match its hash; save it again");
  bytes.resize(size);
  return bytes;
}

void checkHead(const Head& head, const Head& wanted, const std::string& origin)
{
  if (head.format != wanted.format)
    throw InputError(origin, "",
                     "has format " + std::to_string(head.format) + ", this version reads format " +
                         std::to_string(wanted.format) + "; save it again with this version");
  if (head.scene_hash != wanted.scene_hash)
    throw InputError(origin, "",
                     "was saved in another scene, or with other values (hash " + Hash64::toHex(head.scene_hash) +
                         ", this one's is " + Hash64::toHex(wanted.scene_hash) +
                         "); load it with the scene it was saved in");
  if (head.vessel_hash != wanted.vessel_hash)
    throw InputError(origin, "", "was saved in another vessel: the scene's mesh has changed since");
}

}  // namespace

void Simulation::Channel::archive(Archive& archive)
{
  archive(blind_hand, slipped_insertion, slipped_rotation, grip, turning_grip);
}

void Simulation::archive(Archive& archive)
{
  std::uint64_t trajectory = trajectory_.value();
  bool sampled = sampling_ != nullptr;
  archive(steps_, trajectory, state_hash_, pressures_, sampled);
  for (Channel& channel : channels_)
    archive(channel);
  trajectory_.resume(trajectory);
  if (!sampled)
    sampling_.reset();
  if (sampling_)
  {
    archive(*sampling_);
    if (archive.reading())
      stepper_->resample(sampling_->discretisation());
  }
  archive(state_);
  stepper_->archive(archive, state_);
  archive(treatments_);
}

void Simulation::save(std::ostream& stream, std::uint64_t vessel_hash, const std::function<void(Archive&)>& more)
{
  if (scene_.solver.scheme != "kkt")
    throw InputError(scene_.file, "solver.scheme", "'" + scene_.solver.scheme + "' cannot be saved; use kkt");
  Archive out;
  Head head;
  head.scene_hash = scene_.hash();
  head.vessel_hash = vessel_hash;
  out(head);
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
  if (scene_.solver.scheme != "kkt")
    throw InputError(scene_.file, "solver.scheme", "'" + scene_.solver.scheme + "' cannot be loaded; use kkt");
  Archive in(checked({std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()}, origin));
  Head head;
  Head wanted;
  wanted.scene_hash = scene_.hash();
  wanted.vessel_hash = vessel_hash;
  try
  {
    in(head);
    checkHead(head, wanted, origin);
    archive(in);
    if (more)
      more(in);
  }
  catch (const ArchiveError& error)
  {
    throw InputError(origin, "", std::string(error.what()) + "; save it again");
  }
  if (!in.atEnd())
    throw InputError(origin, "", "holds more than a state; save it again");
}

}  // namespace endovascular_sim::simulation
