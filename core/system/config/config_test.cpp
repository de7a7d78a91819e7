#include "core/system/config/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// What setting it says is wrong; empty if nothing.
std::string complaint(const std::string& key, const OptionValue& value) {
  Config config;
  try {
    config.set(key, value);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

// A value the option does not have yet and may have.
OptionValue another_value(const OptionDescription& option) {
  if (const bool* flag = std::get_if<bool>(&option.value)) return !*flag;
  if (const auto* number = std::get_if<std::int64_t>(&option.value))
    return *number < static_cast<std::int64_t>(option.maximum) ? *number + 1 : *number - 1;
  if (const double* number = std::get_if<double>(&option.value))
    return *number == option.maximum ? option.minimum : 0.5 * (*number + option.maximum);
  if (option.allowed.empty()) return std::string("some text");
  return option.allowed.back();
}

TEST(Config, EveryKeyIsUniqueAndSaysWhatItMeans) {
  std::set<std::string> keys;
  for (const OptionDescription& option : Config{}.describe_all()) {
    EXPECT_TRUE(keys.insert(option.key).second) << option.key << " is there twice";
    EXPECT_FALSE(option.meaning.empty()) << option.key;
    EXPECT_EQ(option.value, option.default_value) << option.key;
  }
  EXPECT_TRUE(keys.contains("system.seed"));
  EXPECT_TRUE(keys.contains("tracker.coast_s"));
  EXPECT_TRUE(keys.contains("tracker.keyframe.min_tracked_share"));
  EXPECT_TRUE(keys.contains("tracker.recovery.min_inliers"));
  EXPECT_TRUE(keys.contains("mapper.culling.redundant_share"));
  EXPECT_TRUE(keys.contains("orb.max_features"));
}

// Set to another value, every key is read back, its default is still told, and no other key has changed.
TEST(Config, EveryKeyRoundTripsAndChangesNothingElse) {
  for (const OptionDescription& option : Config{}.describe_all()) {
    Config config;
    const OptionValue value = another_value(option);
    config.set(option.key, value);
    EXPECT_EQ(config.get(option.key), value) << option.key;
    for (const OptionDescription& other : config.describe_all()) {
      if (other.key == option.key) {
        EXPECT_EQ(other.default_value, option.value) << option.key;
      } else {
        EXPECT_EQ(other.value, other.default_value) << other.key << " after setting " << option.key;
      }
    }
  }
}

TEST(Config, DefaultsAreWithinTheirOwnRanges) {
  for (const OptionDescription& option : Config{}.describe_all())
    EXPECT_EQ(complaint(option.key, option.default_value), "") << option.key;
}

TEST(Config, LimitsBelongToTheRangeAndWhatIsBeyondDoesNot) {
  for (const OptionDescription& option : Config{}.describe_all()) {
    if (std::holds_alternative<std::int64_t>(option.value)) {
      const auto low = static_cast<std::int64_t>(option.minimum),
                 high = static_cast<std::int64_t>(option.maximum);
      EXPECT_EQ(complaint(option.key, low) + complaint(option.key, high), "") << option.key;
      EXPECT_THAT(complaint(option.key, low - 1), HasSubstr("'" + option.key + "' must be")) << option.key;
      EXPECT_THAT(complaint(option.key, high + 1), HasSubstr("'" + option.key + "' must be")) << option.key;
    } else if (std::holds_alternative<double>(option.value)) {
      EXPECT_EQ(complaint(option.key, option.minimum) + complaint(option.key, option.maximum), "")
          << option.key;
      EXPECT_NE(complaint(option.key, std::nextafter(option.minimum, -1e9)), "") << option.key;
      EXPECT_NE(complaint(option.key, std::nextafter(option.maximum, 1e9)), "") << option.key;
    }
  }
}

TEST(Config, ComplaintsNameTheRange) {
  EXPECT_EQ(complaint("tracker.coast_s", 7.0), "option 'tracker.coast_s' must be a number from 0 to 5");
  EXPECT_EQ(complaint("orb.levels", std::int64_t{17}),
            "option 'orb.levels' must be a whole number from 1 to 16");
  EXPECT_EQ(complaint("orb.scale_factor", 1.0), "option 'orb.scale_factor' must be a number from 1.05 to 2");
  EXPECT_EQ(complaint("system.execution", std::string("parallel")),
            "option 'system.execution' must be one of: threaded, serial");
}

TEST(Config, NumbersThatAreNoneOrTooLargeAreRefused) {
  EXPECT_NE(complaint("tracker.coast_s", std::numeric_limits<double>::quiet_NaN()), "");
  EXPECT_NE(complaint("tracker.coast_s", std::numeric_limits<double>::infinity()), "");
  EXPECT_NE(complaint("system.seed", std::int64_t{1} << 32), "") << "would be cut to 32 bits";
}

TEST(Config, TypesAreCheckedButAWholeNumberIsANumber) {
  EXPECT_NE(complaint("system.seed", 1.0), "");
  EXPECT_NE(complaint("system.seed", true), "");
  EXPECT_NE(complaint("system.realtime", std::int64_t{1}), "");
  EXPECT_NE(complaint("tracker.coast_s", std::string("1")), "");
  EXPECT_NE(complaint("tracker.coast_s", true), "");
  EXPECT_NE(complaint("system.replay", std::int64_t{1}), "");
  Config config;
  config.set("tracker.coast_s", std::int64_t{2});
  EXPECT_EQ(config.tracker.coast_s, 2.0);
}

TEST(Config, AFailedSetChangesNothing) {
  Config config;
  EXPECT_THROW(config.set("tracker.coast_s", 7.0), InputError);
  EXPECT_EQ(config.tracker.coast_s, Config{}.tracker.coast_s);
}

TEST(Config, UnknownKeysAreToldTheNearest) {
  EXPECT_THAT(complaint("tracker.coast", 1.0), AllOf(HasSubstr("unknown option 'tracker.coast'"),
                                                     HasSubstr("did you mean 'tracker.coast_s'?")));
  EXPECT_THAT(complaint("mapper.culing.redundant_shar", 1.0), HasSubstr("'mapper.culling.redundant_share'"));
  EXPECT_THAT(complaint("sytsem.sed", std::int64_t{1}), HasSubstr("did you mean 'system.seed'?"));
  EXPECT_THAT(complaint("", 1.0), HasSubstr("unknown option ''"));
  EXPECT_THROW(Config{}.get("tracker.coast"), InputError);
}

TEST(Config, RecordingAndReplayingExcludeEachOther) {
  Config config;
  config.set("system.schedule_out", std::string("a"));
  EXPECT_NO_THROW(config.validate());
  config.set("system.replay", std::string("b"));
  EXPECT_THROW(config.validate(), InputError);
}

TEST(Config, ValidationReachesWhatRangesCannotTell) {
  Config config;
  config.set("orb.fast_threshold", std::int64_t{10});
  config.set("orb.fast_threshold_low", std::int64_t{11});
  EXPECT_THROW(config.validate(), InputError);
}

}  // namespace
}  // namespace vsgraphs
