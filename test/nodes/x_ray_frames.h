#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include "endovascular_sim/XRayFrame.h"
#include "nodes/runtime/ros_names.h"
#include "session/session.h"
#include "session/x_ray_run.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/topic_observer.h"

namespace endovascular_sim
{

/** Frames of the node of fluoroscopy and those of a run in this process, which draws every pulse. */
class XRayFrames
{
public:
  /** Messages by their stamps. */
  struct Messages
  {
    std::map<ros::Time, XRayFrame> frames;
    std::map<ros::Time, sensor_msgs::Image> raws, images, dsas;
    XRayFrame last;
  };

  XRayFrames()
  {
    const auto keep = [this](auto Messages::*map)
    { return [this, map](const sensor_msgs::Image& image) { (messages_.*map)[image.header.stamp] = image; }; };
    observer_.subscribe<sensor_msgs::Image>(nodes::names::kFluoroscopyRaw, keep(&Messages::raws));
    observer_.subscribe<sensor_msgs::Image>(nodes::names::kFluoroscopyImage, keep(&Messages::images));
    observer_.subscribe<sensor_msgs::Image>(nodes::names::kFluoroscopyDsa, keep(&Messages::dsas));
    observer_.subscribe<XRayFrame>(nodes::names::kFluoroscopyFrame,
                                   [this](const XRayFrame& frame)
                                   {
                                     messages_.frames[frame.header.stamp] = frame;
                                     messages_.last = frame;
                                   });
  }

  Messages messages() { return observer_.copy(messages_); }

  /** Draws the present state in this process, if it lies at a pulse. */
  void draw(session::XRayRun& run, const session::Session& session)
  {
    if (!run.isDue(session.simulation()))
      return;
    run.draw(session);
    const fluoroscopy::AngiographyFrame& frame = run.frame();
    drawn_[frame.pulse] = {bytesOf(frame.native.raw), frame.native.image, frame.subtracted};
  }

  /** Waits until the graph has drawn a pulse. */
  void waitFor(std::uint64_t pulse)
  {
    ASSERT_TRUE(waitUntil(20.0, [&] { return messages().last.pulse == pulse; })) << messages().last.pulse;
  }

  /** Compares all frames of the graph with those of this process, bit for bit.
   *  @param dsas number of subtracted images compared
   *  @return number of different pulses compared */
  std::size_t compare(std::size_t& dsas)
  {
    waitUntil(1.0, [] { return false; });  // images of the last frame
    const Messages all = messages();
    std::map<std::uint64_t, int> compared;
    dsas = 0;
    for (const auto& [stamp, frame] : all.frames)
    {
      const auto wanted = drawn_.find(frame.pulse);
      if (wanted == drawn_.end() || all.raws.count(stamp) == 0 || all.images.count(stamp) == 0)
        continue;
      EXPECT_TRUE(frame.complete);
      EXPECT_EQ(frame.steps, fluoroscopy::PulseTrain(15.0, 1e-3).stepOf(frame.pulse));
      EXPECT_EQ(frame.time, static_cast<double>(frame.steps) * 1e-3);
      EXPECT_TRUE(all.raws.at(stamp).data == wanted->second.raw) << "pulse " << frame.pulse;
      EXPECT_TRUE(all.images.at(stamp).data == wanted->second.image) << "pulse " << frame.pulse;
      if (all.dsas.count(stamp) > 0)
      {
        EXPECT_TRUE(all.dsas.at(stamp).data == wanted->second.dsa) << "pulse " << frame.pulse;
        ++dsas;
      }
      ++compared[frame.pulse];
    }
    return compared.size();
  }

  /** Forgets the frames of this process. */
  void clear() { drawn_.clear(); }

private:
  /** Images of a pulse as bytes. */
  struct Images
  {
    std::vector<std::uint8_t> raw, image, dsa;
  };

  static std::vector<std::uint8_t> bytesOf(const std::vector<std::uint16_t>& values)
  {
    std::vector<std::uint8_t> bytes(2 * values.size());
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
  }

  Messages messages_;
  std::map<std::uint64_t, Images> drawn_;  ///< in this process, by their pulses
  TopicObserver observer_;                 ///< last, so that it ends before the messages
};

}  // namespace endovascular_sim
