#include "haptics/rosserial/rosserial_messages.h"

#include "haptics/rosserial/byte_stream.h"

namespace endovascular_sim::haptics
{

namespace
{

void put(ByteWriter& writer, const WallTime& time)
{
  writer.put(time.seconds);
  writer.put(time.nanoseconds);
}

void put(ByteWriter& writer, const std::vector<double>& values)
{
  writer.put(static_cast<std::uint32_t>(values.size()));
  for (const double value : values)
    writer.put(value);
}

WallTime getTime(ByteReader& reader)
{
  WallTime time;
  time.seconds = reader.get<std::uint32_t>();
  time.nanoseconds = reader.get<std::uint32_t>();
  return time;
}

std::vector<double> getDoubles(ByteReader& reader)
{
  std::vector<double> values(reader.getCount(sizeof(double)));
  for (double& value : values)
    value = reader.get<double>();
  return values;
}

}  // namespace

Bytes encode(const TopicInfo& info)
{
  ByteWriter writer;
  writer.put(info.id);
  writer.putString(info.name);
  writer.putString(info.type);
  writer.putString(info.md5);
  writer.put(info.buffer_size);
  return writer.take();
}

Bytes encode(const WallTime& time)
{
  ByteWriter writer;
  put(writer, time);
  return writer.take();
}

Bytes encode(const LogLine& line)
{
  ByteWriter writer;
  writer.put(line.level);
  writer.putString(line.text);
  return writer.take();
}

Bytes encode(const HapticSample& sample)
{
  ByteWriter writer;
  writer.put(sample.time);
  writer.put(sample.insertion);
  writer.put(sample.rotation);
  writer.put(sample.flags);
  return writer.take();
}

Bytes encode(const HapticForce& force)
{
  ByteWriter writer;
  writer.put(force.sample_time);
  writer.put(force.force);
  writer.put(force.torque);
  writer.put(static_cast<std::uint8_t>(force.state));
  return writer.take();
}

Bytes encode(const JointState& state)
{
  ByteWriter writer;
  writer.put(state.sequence);
  put(writer, state.stamp);
  writer.putString(state.frame);
  writer.put(static_cast<std::uint32_t>(state.names.size()));
  for (const std::string& name : state.names)
    writer.putString(name);
  put(writer, state.positions);
  put(writer, state.velocities);
  put(writer, state.efforts);
  return writer.take();
}

Bytes encode(const Wrench& wrench)
{
  ByteWriter writer;
  for (const double value : wrench.force)
    writer.put(value);
  for (const double value : wrench.torque)
    writer.put(value);
  return writer.take();
}

Bytes encodeStamped(const Wrench& wrench, const WallTime& stamp)
{
  ByteWriter writer;
  writer.put(std::uint32_t{0});
  put(writer, stamp);
  writer.putString("");
  Bytes bytes = writer.take();
  const Bytes body = encode(wrench);
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

TopicInfo decodeTopicInfo(const Bytes& payload)
{
  ByteReader reader(payload);
  TopicInfo info;
  info.id = reader.get<std::uint16_t>();
  info.name = reader.getString();
  info.type = reader.getString();
  info.md5 = reader.getString();
  info.buffer_size = reader.get<std::int32_t>();
  reader.finish();
  return info;
}

WallTime decodeTime(const Bytes& payload)
{
  ByteReader reader(payload);
  const WallTime time = getTime(reader);
  reader.finish();
  return time;
}

LogLine decodeLog(const Bytes& payload)
{
  ByteReader reader(payload);
  LogLine line;
  line.level = reader.get<std::uint8_t>();
  line.text = reader.getString();
  reader.finish();
  return line;
}

HapticSample decodeHapticSample(const Bytes& payload)
{
  ByteReader reader(payload);
  HapticSample sample;
  sample.time = reader.get<std::uint32_t>();
  sample.insertion = reader.get<float>();
  sample.rotation = reader.get<float>();
  sample.flags = reader.get<std::uint8_t>();
  reader.finish();
  return sample;
}

HapticForce decodeHapticForce(const Bytes& payload)
{
  ByteReader reader(payload);
  HapticForce force;
  force.sample_time = reader.get<std::uint32_t>();
  force.force = reader.get<float>();
  force.torque = reader.get<float>();
  const auto state = reader.get<std::uint8_t>();
  if (state > static_cast<std::uint8_t>(DeviceState::kFault))
    throw PayloadError("state " + std::to_string(state) + " is not one of 0 to 3");
  force.state = static_cast<DeviceState>(state);
  reader.finish();
  return force;
}

JointState decodeJointState(const Bytes& payload)
{
  ByteReader reader(payload);
  JointState state;
  state.sequence = reader.get<std::uint32_t>();
  state.stamp = getTime(reader);
  state.frame = reader.getString();
  state.names.resize(reader.getCount(sizeof(std::uint32_t)));
  for (std::string& name : state.names)
    name = reader.getString();
  state.positions = getDoubles(reader);
  state.velocities = getDoubles(reader);
  state.efforts = getDoubles(reader);
  reader.finish();
  return state;
}

Wrench decodeWrench(const Bytes& payload)
{
  ByteReader reader(payload);
  Wrench wrench;
  for (double& value : wrench.force)
    value = reader.get<double>();
  for (double& value : wrench.torque)
    value = reader.get<double>();
  reader.finish();
  return wrench;
}

}  // namespace endovascular_sim::haptics
