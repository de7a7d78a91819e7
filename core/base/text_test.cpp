#include "core/base/text.h"

#include <gtest/gtest.h>

#include <string>

namespace vsgraphs {
namespace {

TEST(Text, IsWhatUtf8CanHold) {
  for (const std::string text :
       {"", "wall", "T\xc3\xbcr", "\xe2\x82\xac", "\xf0\x9f\x9a\xaa", "\xf4\x8f\xbf\xbf"})
    EXPECT_TRUE(is_text(text)) << text;
}

TEST(Text, IsNothingElse) {
  for (const std::string bytes : {"\xff", "\x80", "\xc3", "\xc3(", "\xe2\x82", "\xf8\x88\x80\x80\x80"})
    EXPECT_FALSE(is_text(bytes)) << bytes;
  EXPECT_FALSE(is_text("\xc0\xaf")) << "longer than it must be";
  EXPECT_FALSE(is_text("\xed\xa0\x80")) << "half a surrogate pair";
  EXPECT_FALSE(is_text("\xf4\x90\x80\x80")) << "beyond the last character";
}

}  // namespace
}  // namespace vsgraphs
