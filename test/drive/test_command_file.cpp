#include "drive/command_file.h"

#include <unistd.h>

#include <gtest/gtest.h>

#include "common/error.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::drive
{
namespace
{

class CommandFile : public testing::Test
{
protected:
  std::vector<TimedCommand> read(const std::string& text) const
  {
    return readCommandFile(folder_.write("commands", text));
  }

  /** Message of the error for a text. */
  std::string refusal(const std::string& text) const
  {
    return inputErrorOf([&] { read(text); });
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_.file("commands");
};

TEST_F(CommandFile, HoldsOneCommandPerRow)
{
  const std::vector<TimedCommand> commands = read(
      "time,instrument,command,insertion,rotation\n# a comment\n\n"
      "0, wire, move_jp, 0.05, 1.5\n0.5,wire,servo_jv,-1e-2\n1,wire,pause\r\n");
  ASSERT_EQ(commands.size(), 3U);
  EXPECT_EQ(commands[0].instrument, "wire");
  EXPECT_EQ(commands[0].word, "move_jp");
  EXPECT_EQ(commands[0].values, (std::vector<double>{0.05, 1.5}));
  EXPECT_EQ(commands[1].values, std::vector<double>{-0.01});
  EXPECT_EQ(commands[2].word, "pause");
  EXPECT_EQ(commands[2].line, 6);
}

TEST_F(CommandFile, OfASpreadsheetIsRead)
{
  const std::string row = "\"0.5\",\"wire\",move_jp,0.06,1.5\r\n";
  for (const std::string& text : {"\xEF\xBB\xBFtime,instrument,command,values\r\n" + row,
                                  "# from a robot\n\ntime,instrument,command,values\n" + row + ",,,,\n"})
  {
    const std::vector<TimedCommand> commands = read(text);
    ASSERT_EQ(commands.size(), 1U) << text;
    EXPECT_EQ(commands[0].time, 0.5);
    EXPECT_EQ(commands[0].instrument, "wire");
  }
}

TEST_F(CommandFile, RefusesAWrongRowWithItsLineAndTheReason)
{
  EXPECT_NE(refusal("0,wire,servo_jp,0.1\n1,wire,servo_jx,0.1\n").find("line 2: unknown command"), std::string::npos);
  EXPECT_NE(refusal("x,wire,servo_jp,0.1\n").find("'x' is not a finite number"), std::string::npos);
  EXPECT_NE(refusal("0,wire,servo_jp,nan\n").find("'nan' is not a finite number"), std::string::npos);
  EXPECT_NE(refusal("0,wire,servo_jp\n").find("one to three values"), std::string::npos);
  EXPECT_NE(refusal("0,wire,servo_jp,1,2,3,4\n").find("one to three values"), std::string::npos);
  EXPECT_NE(refusal("0,wire,pause,1\n").find("has no values"), std::string::npos);
  EXPECT_NE(refusal("0,wire\n").find("expected time"), std::string::npos);
  EXPECT_NE(refusal("1,wire,pause\n0,wire,resume\n").find("sort the rows"), std::string::npos);
  EXPECT_THROW(readCommandFile("/nonexistent.csv"), InputError);
}

}  // namespace
}  // namespace endovascular_sim::drive
