#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/** rosserial's wire protocol, version 2 (docs/HAPTIC_DEVICE.md):
 *
 *      FF FE | lenLo lenHi | lenChk | idLo idHi | payload (len bytes) | msgChk
 *
 *  with lenLo + lenHi + lenChk = 255 (mod 256) and idLo + idHi + payload + msgChk = 255 (mod 256). */
namespace endovascular_sim::haptics
{

using Bytes = std::vector<std::uint8_t>;

/** Topic ids with a fixed meaning; a device numbers its own topics from kFirstApplicationId. */
enum TopicId : std::uint16_t
{
  kPublisher = 0,  ///< from the device: it publishes a topic; from the host, empty: announce all topics
  kSubscriber = 1,
  kServiceServerPublisher = 2,
  kServiceServerSubscriber = 3,
  kServiceClientPublisher = 4,
  kServiceClientSubscriber = 5,
  kParameterRequest = 6,
  kLog = 7,
  kTime = 10,
  kTxStop = 11,
  kFirstApplicationId = 100,
};

constexpr std::size_t kHeaderSize = 7;                   ///< bytes before the payload
constexpr std::size_t kFrameOverhead = kHeaderSize + 1;  ///< bytes around the payload
constexpr std::size_t kDefaultPayloadCap = 1024;         ///< longest payload that a parser accepts by default [bytes]

struct Frame
{
  std::uint16_t id = 0;
  Bytes payload;
};

/** The bytes of one frame. @throws std::length_error when the payload is longer than 65535 bytes */
Bytes encodeFrame(std::uint16_t id, const Bytes& payload);

/** The host's question for all topics: ff fe 00 00 ff 00 00 ff. */
Bytes encodeTopicRequest();

/** What a parser has seen since it was made. */
struct ParserCounters
{
  std::uint64_t bytes = 0;          ///< bytes fed
  std::uint64_t frames = 0;         ///< valid frames
  std::uint64_t bad_lengths = 0;    ///< headers whose length check fails
  std::uint64_t over_long = 0;      ///< headers that announce more than the cap
  std::uint64_t bad_sums = 0;       ///< frames whose message check fails
  std::uint64_t resyncs = 0;        ///< times that synchronisation was lost
  std::uint64_t skipped_bytes = 0;  ///< bytes that belong to no valid frame
};

/** Finds frames in a stream of bytes, fed in pieces of any size.
 *
 *  After any failure the search goes on at the byte after the false sync, so a valid frame behind garbage is found
 *  once payloadCap + kFrameOverhead bytes behind the garbage's start of frame have come. The result does not depend on
 *  how the stream is cut. Memory is bounded by the cap and the largest piece. */
class FrameParser
{
public:
  explicit FrameParser(std::size_t payloadCap = kDefaultPayloadCap) : payload_cap_(payloadCap) {}

  /** Takes bytes and appends the frames they complete to @p frames. */
  void feed(const std::uint8_t* data, std::size_t size, std::vector<Frame>& frames);

  /** Forgets a half-read frame (the line was closed); the counters stay. */
  void reset();

  const ParserCounters& counters() const { return counters_; }

private:
  enum class Verdict
  {
    kIncomplete,
    kFrame,
    kFalseSync,
  };

  /** Judges what begins at begin_. */
  Verdict examine();
  void skipByte();

  std::size_t payload_cap_;
  Bytes buffer_;
  std::size_t begin_ = 0;  ///< first byte of buffer_ that is not consumed
  bool in_sync_ = true;    ///< the last byte consumed ended a valid frame
  ParserCounters counters_;
};

}  // namespace endovascular_sim::haptics
