#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/** Wire protocol of rosserial, version 2 (docs/HAPTIC_DEVICE.md):
 *
 *      FF FE | lenLo lenHi | lenChk | idLo idHi | payload (len bytes) | msgChk
 *
 *  with lenLo + lenHi + lenChk = 255 (mod 256) and idLo + idHi + payload + msgChk = 255 (mod 256). */
namespace endovascular_sim::haptics
{

using Bytes = std::vector<std::uint8_t>;

/** Topic ids with a fixed meaning. A device numbers its own topics from kFirstApplicationId. */
enum TopicId : std::uint16_t
{
  kPublisher = 0,  ///< announcement of a published topic by the device; if empty, topic request by the host
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

constexpr std::size_t kHeaderSize = 7;                   ///< size of the header [bytes]
constexpr std::size_t kFrameOverhead = kHeaderSize + 1;  ///< size of header and message checksum [bytes]
constexpr std::size_t kDefaultPayloadCap = 1024;         ///< default limit of the payload in a parser [bytes]

struct Frame
{
  std::uint16_t id = 0;
  Bytes payload;
};

/** Encodes one frame.
 *  @throws std::length_error if the payload is longer than 65535 bytes */
Bytes encodeFrame(std::uint16_t id, const Bytes& payload);

/** Encodes the host's topic request: ff fe 00 00 ff 00 00 ff. */
Bytes encodeTopicRequest();

/** Statistics of a parser since its construction. */
struct ParserCounters
{
  std::uint64_t bytes = 0;          ///< bytes received
  std::uint64_t frames = 0;         ///< valid frames
  std::uint64_t bad_lengths = 0;    ///< headers with a wrong length checksum
  std::uint64_t over_long = 0;      ///< headers with a length above the limit
  std::uint64_t bad_sums = 0;       ///< frames with a wrong message checksum
  std::uint64_t resyncs = 0;        ///< losses of synchronisation
  std::uint64_t skipped_bytes = 0;  ///< bytes outside valid frames
};

/** Incremental parser that extracts frames from a stream of bytes.
 *
 *  After a failure, the search continues at the byte after the false start of frame. A valid frame after garbage is
 *  therefore found at the latest payloadCap + kFrameOverhead bytes after that false start. The result does not depend
 *  on the division of the stream into pieces. Memory is bounded by the payload limit and the largest piece. */
class FrameParser
{
public:
  explicit FrameParser(std::size_t payloadCap = kDefaultPayloadCap) : payload_cap_(payloadCap) {}

  /** Parses bytes and appends the completed frames to @p frames. */
  void feed(const std::uint8_t* data, std::size_t size, std::vector<Frame>& frames);

  /** Discards an incomplete frame after the line was closed; the counters remain. */
  void reset();

  const ParserCounters& counters() const { return counters_; }

private:
  enum class Verdict
  {
    kIncomplete,
    kFrame,
    kFalseSync,
  };

  /** Classifies the bytes from begin_. */
  Verdict examine();
  void skipByte();

  std::size_t payload_cap_;
  Bytes buffer_;
  std::size_t begin_ = 0;  ///< first byte of buffer_ that is not consumed
  bool in_sync_ = true;    ///< true if the last consumed byte ended a valid frame
  ParserCounters counters_;
};

}  // namespace endovascular_sim::haptics
