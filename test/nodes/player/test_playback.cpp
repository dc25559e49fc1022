#include "nodes/player/playback.h"

#include <cmath>

#include <gtest/gtest.h>

#include "endovascular_sim/PlayerControl.h"
#include "nodes/player/recorded_course.h"
#include "test/nodes/player/played_session.h"

namespace endovascular_sim::nodes
{
namespace
{

using Command = PlayerControl::Request;

class PlayedBack : public testing::Test
{
protected:
  explicit PlayedBack(const PlayedFaults& faults = {}) : session(folder.file("session.bag"), faults) {}

  /** Plays for a time in ticks of 10 ms. @return number of messages of rod/state_visual that were passed */
  int play(double seconds)
  {
    int states = 0;
    for (int k = 0; k < std::lround(seconds / 0.01); ++k)
    {
      const PlayedSpan span = playback.advance(0.01);
      for (std::size_t entry = span.first; entry < span.last; ++entry)
        states += timeline.topics()[timeline.streams()[timeline.entries()[entry].stream].topic].name ==
                          std::string("/room/") + names::kRodStateVisual
                      ? 1
                      : 0;
    }
    return states;
  }
  double shown() const { return timeline.states()[playback.state()].simulated; }

  TemporaryFolder folder;
  const PlayedSession session;
  const BagTimeline timeline{{session.file()}};
  const RecordedCourse course{timeline};
  Playback playback{timeline, course.chapters()};
};

class WithAPause : public PlayedBack
{
protected:
  static PlayedFaults pause()
  {
    PlayedFaults faults;
    faults.pause_after = 50;
    return faults;
  }
  WithAPause() : PlayedBack(pause()) {}
};

TEST_F(PlayedBack, BeginsWithItsFirstStateAndDoesNotPlay)
{
  EXPECT_TRUE(playback.takeJump().is_jump);
  EXPECT_EQ(playback.state(), 0U);
  EXPECT_EQ(play(1.0), 0);
}

TEST_F(PlayedBack, PassesEveryMessageOnceAtEveryRate)
{
  for (const double rate : {0.1, 1.0, 10.0})
  {
    EXPECT_EQ(playback.control(Command::SEEK_TIME, 0.0), "");
    EXPECT_EQ(playback.control(Command::RATE, rate), "");
    EXPECT_EQ(playback.control(Command::PLAY, 0.0), "");
    EXPECT_NEAR(play(1.0 / rate), 10, 1) << rate;
    EXPECT_NEAR(shown(), 1.0, 0.11) << rate;
    playback.control(Command::PAUSE, 0.0);
  }
  playback.control(Command::SEEK_TIME, 0.0);
  playback.control(Command::PLAY, 0.0);
  EXPECT_EQ(play(2.0), 99) << "all but the shown one";
  EXPECT_FALSE(playback.isPlaying());
  EXPECT_EQ(playback.state(), 99U);
}

TEST_F(PlayedBack, BeginsAgainWhereItLoops)
{
  playback.control(Command::LOOP, 1.0);
  playback.control(Command::SEEK_TIME, 9.8);
  playback.control(Command::PLAY, 0.0);
  play(0.6);
  EXPECT_TRUE(playback.isPlaying());
  EXPECT_LT(shown(), 1.0);
  playback.control(Command::LOOP, 0.0);
  playback.control(Command::SEEK_TIME, 9.8);
  play(0.6);
  EXPECT_FALSE(playback.isPlaying());
  EXPECT_EQ(playback.control(Command::PLAY, 0.0), "");
  EXPECT_EQ(playback.state(), 0U) << "from the end it begins again";
}

TEST_F(PlayedBack, StepsByRecordedStatesAndPauses)
{
  playback.control(Command::SEEK_TIME, 3.0);
  playback.control(Command::PLAY, 0.0);
  EXPECT_EQ(playback.control(Command::STEP, 1.0), "");
  EXPECT_FALSE(playback.isPlaying());
  EXPECT_EQ(playback.state(), 31U);
  playback.control(Command::STEP, -2.0);
  EXPECT_EQ(playback.state(), 29U);
  playback.control(Command::STEP, -1000.0);
  EXPECT_EQ(playback.state(), 0U);
  playback.control(Command::STEP, 1000.0);
  EXPECT_EQ(playback.state(), 99U);
}

TEST_F(PlayedBack, SeeksTimesStepsAndChapters)
{
  const std::uint32_t jumps = playback.jumps();
  EXPECT_EQ(playback.control(Command::SEEK_TIME, 4.05), "");
  EXPECT_EQ(playback.state(), 40U);
  EXPECT_EQ(playback.control(Command::SEEK_STEP, 4250), "");
  EXPECT_EQ(playback.state(), 42U);
  EXPECT_EQ(playback.control(Command::SEEK_CHAPTER, 2), "");
  EXPECT_EQ(playback.state(), 50U);
  EXPECT_EQ(playback.jumps(), jumps + 3);
  EXPECT_EQ(playback.presentChapter(), 3U);
}

TEST_F(PlayedBack, SkipsFromChapterToChapter)
{
  playback.control(Command::SEEK_TIME, 0.0);
  std::vector<std::size_t> found;
  while (playback.control(Command::SKIP_CHAPTERS, 1.0).empty())
    found.push_back(playback.state());
  EXPECT_EQ(found, (std::vector<std::size_t>{25, 50, 55, 75}));
  playback.control(Command::SEEK_TIME, 6.0);
  playback.control(Command::SKIP_CHAPTERS, -1.0);
  EXPECT_EQ(playback.state(), 55U) << "the beginning of the present one";
  playback.control(Command::SKIP_CHAPTERS, -1.0);
  EXPECT_EQ(playback.state(), 50U);
  playback.control(Command::SKIP_CHAPTERS, -9.0);
  EXPECT_EQ(playback.state(), 0U);
}

TEST_F(PlayedBack, RefusesWhatIsNotPossibleWithoutAnEffect)
{
  playback.control(Command::SEEK_TIME, 3.0);
  const std::size_t state = playback.state();
  for (const auto& [command, value] :
       {std::pair(Command::RATE, 0.01), std::pair(Command::RATE, 20.0), std::pair(Command::SEEK_TIME, std::nan("")),
        std::pair(Command::SEEK_STEP, -1.0), std::pair(Command::SEEK_STEP, 1.5), std::pair(Command::SEEK_CHAPTER, 6.0),
        std::pair(Command::STEP, 0.5), std::pair(Command::SKIP_CHAPTERS, 0.0)})
    EXPECT_NE(playback.control(command, value), "") << static_cast<int>(command) << " " << value;
  EXPECT_NE(playback.control(99, 0.0), "");
  EXPECT_EQ(playback.state(), state);
  EXPECT_EQ(playback.rate(), 1.0);
}

TEST_F(WithAPause, SkipsAPauseOfTheSession)
{
  playback.control(Command::SEEK_TIME, 4.9);
  playback.control(Command::PLAY, 0.0);
  play(2.5);
  EXPECT_GT(shown(), 5.5) << "a pause of a minute took a second";
  EXPECT_LT(shown(), 7.0);
}

}  // namespace
}  // namespace endovascular_sim::nodes
