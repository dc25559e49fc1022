#include <gtest/gtest.h>
#include <ros/ros.h>

/** Runs the tests of a graph. Callbacks are called in a test that asks for them, or in the thread of CallbackThread. */
int main(int argc, char** argv)
{
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "graph_test");
  const ros::NodeHandle keep_alive;  // destroying the last handle would shut the node down between two tests
  return RUN_ALL_TESTS();
}
