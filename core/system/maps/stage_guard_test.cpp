#include "core/system/maps/stage_guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace vsgraphs {
namespace {

void fail() { throw std::runtime_error("no such wall"); }

TEST(StageGuard, AStageThatFailsIsSwitchedOffAndOthersGoOn) {
  StageGuard guard(false);
  int done = 0;
  EXPECT_TRUE(guard.run("rooms", [&done] { ++done; }));
  EXPECT_FALSE(guard.run("rooms", fail));
  EXPECT_FALSE(guard.run("rooms", [&done] { ++done; })) << "stays off";
  EXPECT_TRUE(guard.run("loops", [&done] { ++done; }));
  EXPECT_EQ(done, 2);
  EXPECT_TRUE(guard.is_off("rooms"));
  EXPECT_FALSE(guard.is_off("loops"));
  EXPECT_THAT(*guard.warnings(), testing::ElementsAre(testing::AllOf(testing::HasSubstr("rooms failed"),
                                                                     testing::HasSubstr("no such wall"))));
}

TEST(StageGuard, WhereFaultsStopTheRunTheyGoOn) {
  StageGuard guard(true);
  EXPECT_THROW(guard.run("rooms", fail), std::runtime_error);
  EXPECT_FALSE(guard.is_off("rooms"));
}

}  // namespace
}  // namespace vsgraphs
