#include "nodes/session/bag_records.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <string_view>
#include <vector>

#include <roslz4/lz4s.h>

#include "common/output_file.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::string_view kVersionLine = "#ROSBAG V2.0\n";
constexpr std::uint64_t kLargestChunk = 1U << 30U;  ///< largest chunk after decompression [B]
constexpr std::uint64_t kLargestRatio = 256;        ///< upper bound of LZ4's compression ratio

/** Kinds of records, field `op`. */
enum Op : std::uint8_t
{
  kMessageData = 2,
  kBagHeader = 3,
  kIndexData = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7,
};

/** Error of a record; the text completes "the bag is damaged: ". */
class Damage : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

std::uint32_t lengthAt(const char* bytes)
{
  std::uint32_t length = 0;
  std::memcpy(&length, bytes, sizeof length);
  return length;
}

/** Fields of a record's header. */
class Fields
{
public:
  /** @throws Damage for an invalid header */
  explicit Fields(std::string_view header)
  {
    while (!header.empty())
    {
      const std::string_view field = taken(header);
      const std::size_t equals = field.find('=');
      if (equals == std::string_view::npos)
        throw Damage("a field of a record has no value");
      fields_[std::string(field.substr(0, equals))] = field.substr(equals + 1);
    }
  }

  /** Removes a text with its length in front from the beginning of @p bytes.
   *  @throws Damage when it is longer than the bytes */
  static std::string_view taken(std::string_view& bytes)
  {
    constexpr std::size_t kLength = sizeof(std::uint32_t);
    if (bytes.size() < kLength || lengthAt(bytes.data()) > bytes.size() - kLength)
      throw Damage("a record is longer than its chunk");
    const std::string_view text = bytes.substr(kLength, lengthAt(bytes.data()));
    bytes.remove_prefix(kLength + text.size());
    return text;
  }

  bool has(const std::string& name) const { return fields_.count(name) > 0; }

  std::string text(const std::string& name) const
  {
    const auto field = fields_.find(name);
    if (field == fields_.end())
      throw Damage("a record has no field '" + name + "'");
    return std::string(field->second);
  }

  template <typename T>
  T number(const std::string& name) const
  {
    const std::string bytes = text(name);
    T value{};
    if (bytes.size() != sizeof value)
      throw Damage("the field '" + name + "' of a record has a wrong length");
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }

private:
  std::map<std::string, std::string_view> fields_;
};

/** Decompresses the data of a chunk.
 *  @param size after decompression, by the header of the chunk [B]
 *  @throws Damage when it cannot be decompressed, or its compression is unknown */
void decompress(const std::string& compression, std::uint64_t size, std::vector<char>& data, std::vector<char>& chunk)
{
  if (compression != "lz4")
    throw Damage("unknown compression '" + compression.substr(0, 20) + "'");
  if (size > kLargestChunk || size > kLargestRatio * (data.size() + 1))
    throw Damage("impossible size");
  chunk.resize(size);
  auto written = static_cast<unsigned int>(size);
  const int result =
      roslz4_buffToBuffDecompress(data.data(), static_cast<unsigned int>(data.size()), chunk.data(), &written);
  if (result != ROSLZ4_OK || written != size)
    throw Damage("it cannot be decompressed");
}

/** Reader of one bag. */
class BagReader
{
public:
  BagReader(const std::string& file, const std::function<void(const BagMessage&)>& visit) : file_(file), visit_(visit)
  {
    errno = 0;
    stream_.open(file, std::ios::binary);
    std::array<char, kVersionLine.size()> line{};
    if (!stream_ || (!stream_.read(line.data(), line.size()) && errno != 0))
      throw InputError(file, "", "cannot be read (" + systemReason() + "); give the path of a session.bag");
    if (!stream_ || std::string_view(line.data(), line.size()) != kVersionLine)
      throw InputError(file, "", "is no bag of version 2.0; give the session.bag of a results folder");
    stream_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(stream_.tellg());
    stream_.seekg(static_cast<std::streamoff>(kVersionLine.size()));
    at_ = kVersionLine.size();
  }

  /** Reads all records. @return the first damage; empty without one */
  std::string read()
  {
    try
    {
      while (at_ < size_)
        readRecord();
      checkCounts();
    }
    catch (const Damage& damage)
    {
      addDamage(damage.what());
    }
    return damage_;
  }

private:
  void addDamage(const std::string& damage)
  {
    if (damage_.empty())
      damage_ = damage;
  }

  /** Reads a length and as many bytes. */
  void readBlock(std::vector<char>& block)
  {
    std::array<char, sizeof(std::uint32_t)> length{};
    if (size_ - at_ < length.size() || !stream_.read(length.data(), length.size()))
      throw Damage("it ends inside a record, after " + std::to_string(size_) + " bytes");
    at_ += length.size();
    const std::uint32_t size = lengthAt(length.data());
    if (size > size_ - at_)
      throw Damage("it ends inside a record, after " + std::to_string(size_) + " bytes");
    block.resize(size);
    if (!stream_.read(block.data(), size))
      throw Damage("it cannot be read beyond byte " + std::to_string(at_));
    at_ += size;
  }

  void readRecord()
  {
    record_ = at_;
    readBlock(header_);
    readBlock(data_);
    const Fields fields(std::string_view(header_.data(), header_.size()));
    switch (fields.number<std::uint8_t>("op"))
    {
      case kBagHeader:
        index_position_ = fields.number<std::uint64_t>("index_pos");
        expected_chunks_ = fields.number<std::uint32_t>("chunk_count");
        expected_connections_ = fields.number<std::uint32_t>("conn_count");
        return;
      case kChunk:
        ++chunks_;
        readChunk(fields);
        return;
      case kConnection:
        ++indexed_connections_;
        return;
      case kChunkInfo:
        ++indexed_chunks_;
        return;
      case kIndexData:
        return;
      default:
        throw Damage("it has an unknown kind of record before byte " + std::to_string(at_));
    }
  }

  /** Reads the messages of a chunk; a damaged one is omitted. */
  void readChunk(const Fields& fields)
  {
    const std::string compression = fields.text("compression");
    if (compression == "bz2")
      throw InputError(file_, "", "is compressed with bzip2; decompress it first: rosbag decompress " + file_);
    try
    {
      readMessages(compression == "none" ? std::string_view(data_.data(), data_.size())
                                         : decompressed(compression, fields.number<std::uint32_t>("size")));
    }
    catch (const Damage& damage)
    {
      addDamage("chunk " + std::to_string(chunks_) + ": " + damage.what());
    }
  }

  std::string_view decompressed(const std::string& compression, std::uint64_t size)
  {
    decompress(compression, size, data_, chunk_);
    return {chunk_.data(), chunk_.size()};
  }

  void readMessages(std::string_view chunk)
  {
    begin_of_chunk_ = chunk.data();
    while (!chunk.empty())
    {
      const Fields fields(Fields::taken(chunk));
      std::string_view data = Fields::taken(chunk);
      const auto op = fields.number<std::uint8_t>("op");
      if (op == kConnection)
        addConnection(fields, data);
      else if (op == kMessageData)
        visitMessage(fields, data);
      else
        throw Damage("unknown kind of record");
    }
  }

  void addConnection(const Fields& fields, std::string_view data)
  {
    const Fields description(data);
    BagMessage& connection = connections_[fields.number<std::uint32_t>("conn")];
    connection.recorded_topic = fields.text("topic");
    connection.topic = presentTopic(connection.recorded_topic);
    connection.type = description.text("type");
    connection.is_latched = description.has("latching") && description.text("latching") == "1";
    connection.md5sum = description.text("md5sum");
    connection.definition = description.text("message_definition");
  }

  void visitMessage(const Fields& fields, std::string_view data)
  {
    const auto found = connections_.find(fields.number<std::uint32_t>("conn"));
    if (found == connections_.end())
      throw Damage("a message has an unknown topic");
    BagMessage message = found->second;
    message.data = reinterpret_cast<const std::uint8_t*>(data.data());
    message.size = static_cast<std::uint32_t>(data.size());
    message.chunk = record_;
    message.offset = static_cast<std::uint32_t>(data.data() - begin_of_chunk_);
    const auto time = fields.number<std::uint64_t>("time");  // seconds, then nanoseconds, 32 bits each
    message.time = ros::Time(static_cast<std::uint32_t>(time), static_cast<std::uint32_t>(time >> 32U) % 1000000000U);
    visit_(message);
  }

  /** Checks the counts of the bag's header, which is completed when the bag is closed. */
  void checkCounts() const
  {
    if (index_position_ == 0)
      throw Damage("it was not closed, because the session was killed");
    if (chunks_ != expected_chunks_ || indexed_chunks_ != expected_chunks_ ||
        indexed_connections_ != expected_connections_)
      throw Damage("it has " + std::to_string(chunks_) + " of " + std::to_string(expected_chunks_) +
                   " chunks, or lost its index");
  }

  std::string file_;
  const std::function<void(const BagMessage&)>& visit_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;                ///< size of the file [B]
  std::uint64_t at_ = 0;                  ///< position in the file [B]
  std::uint64_t record_ = 0;              ///< position of the present record [B]
  const char* begin_of_chunk_ = nullptr;  ///< bytes of the present chunk
  std::vector<char> header_, data_, chunk_;
  std::map<std::uint32_t, BagMessage> connections_;  ///< topic and type of every connection
  std::uint64_t index_position_ = 0;
  std::uint32_t expected_chunks_ = 0, expected_connections_ = 0;
  std::uint32_t chunks_ = 0, indexed_chunks_ = 0, indexed_connections_ = 0;
  std::string damage_;
};

}  // namespace

std::string readBagMessages(const std::string& file, const std::function<void(const BagMessage&)>& visit)
{
  return BagReader(file, visit).read();
}

namespace
{

constexpr std::size_t kKeptChunks = 48;                    ///< of a session: those of all its topics at one time
constexpr std::uint64_t kKeptBytes = 64U * 1024U * 1024U;  ///< of all kept chunks, unless it is a single one [B]

}  // namespace

BagChunks::BagChunks(const std::string& file) : file_(file), stream_(file, std::ios::binary)
{
  if (!stream_)
    throw InputError(file, "", "cannot be read (" + systemReason() + "); give the path of a session.bag");
}

const std::uint8_t* BagChunks::data(std::uint64_t chunk, std::uint32_t offset, std::uint32_t size)
{
  const std::vector<char>& bytes = chunkAt(chunk);
  if (offset > bytes.size() || size > bytes.size() - offset)
    throw InputError(file_, "", "has changed while it was read; open it again");
  return reinterpret_cast<const std::uint8_t*>(bytes.data()) + offset;
}

const std::vector<char>& BagChunks::chunkAt(std::uint64_t position)
{
  const auto known =
      std::find_if(kept_.begin(), kept_.end(), [position](const Chunk& chunk) { return chunk.first == position; });
  if (known != kept_.end())
  {
    kept_.splice(kept_.begin(), kept_, known);
    return kept_.front().second;
  }
  try
  {
    std::vector<char> header, data, chunk;
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(position));
    for (std::vector<char>* block : {&header, &data})
    {
      std::array<char, sizeof(std::uint32_t)> length{};
      if (!stream_.read(length.data(), length.size()) || lengthAt(length.data()) > kLargestChunk)
        throw Damage("no record");
      block->resize(lengthAt(length.data()));
      if (!stream_.read(block->data(), static_cast<std::streamsize>(block->size())))
        throw Damage("no record");
    }
    const Fields fields(std::string_view(header.data(), header.size()));
    if (fields.text("compression") == "none")
      chunk = std::move(data);
    else
      decompress(fields.text("compression"), fields.number<std::uint32_t>("size"), data, chunk);
    kept_.emplace_front(position, std::move(chunk));
  }
  catch (const Damage&)
  {
    throw InputError(file_, "", "has changed while it was read; open it again");
  }
  std::uint64_t bytes = 0;
  for (auto chunk = kept_.begin(); chunk != kept_.end(); ++chunk)
  {
    bytes += chunk->second.size();
    if (chunk != kept_.begin() && bytes > kKeptBytes)
    {
      kept_.erase(chunk, kept_.end());
      break;
    }
  }
  if (kept_.size() > kKeptChunks)
    kept_.pop_back();
  return kept_.front().second;
}

}  // namespace endovascular_sim::nodes
