#pragma once

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "haptics/rosserial/rosserial_protocol.h"

/** Recordings of the original rosserial client and server over raw ptys. Each line has the time [s], the sender
 *  (H: host, D: device) and the bytes in hexadecimal. */
namespace endovascular_sim::haptics::test
{

struct Piece
{
  double time = 0.0;         ///< time since the start of the recording [s]
  bool from_device = false;  ///< sender; false: host
  Bytes bytes;
};

inline Bytes fromHex(const std::string& text)
{
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  return bytes;
}

/** Folder of the recordings, next to the test vessels; empty if ENDOVASCULAR_DATA_DIR is not set. */
inline std::string recordingFolder()
{
  const char* data = std::getenv("ENDOVASCULAR_DATA_DIR");
  return data == nullptr ? std::string() : std::string(data) + "/../rosserial/";
}

inline constexpr auto kNoRecordings =
    "set ENDOVASCULAR_DATA_DIR to the folder of test data; the recordings are expected in rosserial/ next to it";

/** Reads a recording; empty if the file is missing. */
inline std::vector<Piece> readRecording(const std::string& name)
{
  std::ifstream file(recordingFolder() + name);
  std::vector<Piece> pieces;
  std::string line;
  while (std::getline(file, line))
  {
    std::istringstream words(line);
    Piece piece;
    std::string sender;
    std::string hex;
    words >> piece.time >> sender >> hex;
    piece.from_device = sender == "D";
    piece.bytes = fromHex(hex);
    pieces.push_back(piece);
  }
  return pieces;
}

inline Bytes joined(const std::vector<Piece>& pieces, bool from_device)
{
  Bytes bytes;
  for (const Piece& piece : pieces)
    if (piece.from_device == from_device)
      bytes.insert(bytes.end(), piece.bytes.begin(), piece.bytes.end());
  return bytes;
}

inline std::vector<Frame> parseAll(FrameParser& parser, const Bytes& bytes)
{
  std::vector<Frame> frames;
  parser.feed(bytes.data(), bytes.size(), frames);
  return frames;
}

}  // namespace endovascular_sim::haptics::test
