#include "haptics/rosserial/rosserial_protocol.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace endovascular_sim::haptics
{

namespace
{

constexpr std::uint8_t kSync = 0xff;
constexpr std::uint8_t kVersion = 0xfe;
constexpr std::size_t kLengthCheckEnd = 5;  // bytes of sync, version, length and length checksum

/** Checksum: the byte that completes a sum to 255 (mod 256). */
std::uint8_t complement(unsigned sum)
{
  return static_cast<std::uint8_t>(255U - (sum & 0xffU));
}

std::uint8_t low(std::size_t value)
{
  return static_cast<std::uint8_t>(value & 0xffU);
}
std::uint8_t high(std::size_t value)
{
  return static_cast<std::uint8_t>((value >> 8U) & 0xffU);
}

}  // namespace

Bytes encodeFrame(std::uint16_t id, const Bytes& payload)
{
  const std::size_t length = payload.size();
  if (length > 0xffff)
    throw std::length_error("a rosserial frame carries at most 65535 bytes");
  const Bytes header = {kSync,   kVersion, low(length), high(length), complement(low(length) + high(length)),
                        low(id), high(id)};
  Bytes bytes(length + kFrameOverhead);
  std::copy(header.begin(), header.end(), bytes.begin());
  std::copy(payload.begin(), payload.end(), bytes.begin() + kHeaderSize);
  bytes.back() = complement(std::accumulate(payload.begin(), payload.end(), unsigned{low(id)} + high(id)));
  return bytes;
}

Bytes encodeTopicRequest()
{
  return encodeFrame(kPublisher, {});
}

void FrameParser::feed(const std::uint8_t* data, std::size_t size, std::vector<Frame>& frames)
{
  counters_.bytes += size;
  buffer_.insert(buffer_.end(), data, data + size);
  for (Verdict verdict = Verdict::kFalseSync; verdict != Verdict::kIncomplete;)
  {
    verdict = examine();
    if (verdict == Verdict::kFalseSync)
      skipByte();
    if (verdict != Verdict::kFrame)
      continue;
    const std::uint8_t* start = buffer_.data() + begin_;
    const std::size_t length = start[2] + 256U * start[3];
    Frame frame;
    frame.id = static_cast<std::uint16_t>(start[5] + 256U * start[6]);
    frame.payload.assign(start + kHeaderSize, start + kHeaderSize + length);
    frames.push_back(std::move(frame));
    begin_ += length + kFrameOverhead;
    in_sync_ = true;
    ++counters_.frames;
  }
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
  begin_ = 0;
}

FrameParser::Verdict FrameParser::examine()
{
  const std::size_t available = buffer_.size() - begin_;
  const std::uint8_t* start = buffer_.data() + begin_;
  if (available >= 1 && start[0] != kSync)
    return Verdict::kFalseSync;
  if (available >= 2 && start[1] != kVersion)
    return Verdict::kFalseSync;
  if (available < kLengthCheckEnd)
    return Verdict::kIncomplete;
  if (complement(start[2] + start[3]) != start[4])
  {
    ++counters_.bad_lengths;
    return Verdict::kFalseSync;
  }
  const std::size_t length = start[2] + 256U * start[3];
  if (length > payload_cap_)
  {
    ++counters_.over_long;
    return Verdict::kFalseSync;
  }
  if (available < length + kFrameOverhead)
    return Verdict::kIncomplete;
  const unsigned sum = std::accumulate(start + kLengthCheckEnd, start + kHeaderSize + length, 0U);
  if (complement(sum) != start[kHeaderSize + length])
  {
    ++counters_.bad_sums;
    return Verdict::kFalseSync;
  }
  return Verdict::kFrame;
}

void FrameParser::skipByte()
{
  if (in_sync_)
    ++counters_.resyncs;
  in_sync_ = false;
  ++begin_;
  ++counters_.skipped_bytes;
}

void FrameParser::reset()
{
  buffer_.clear();
  begin_ = 0;
  in_sync_ = true;
}

}  // namespace endovascular_sim::haptics
