#include "core/base/copy_on_write.h"

#include <gtest/gtest.h>

namespace vsgraphs {
namespace {

using Shared = CopyOnWrite<int>;

TEST(CopyOnWrite, CopiesShareUntilOneChanges) {
  Shared a(1);
  Shared b = a;
  EXPECT_EQ(&*a, &*b);
  b.edit() = 2;
  EXPECT_EQ(*a, 1);
  EXPECT_EQ(*b, 2);
}

TEST(CopyOnWrite, TheOneCopiedFromDoesNotChangeItsCopies) {
  Shared a(1);
  const Shared b = a;
  Shared c(7);
  c = a;
  a.edit() = 2;
  EXPECT_EQ(*b, 1);
  EXPECT_EQ(*c, 1);
}

TEST(CopyOnWrite, WhatIsItsOwnIsChangedInPlace) {
  Shared a(1);
  const int* at = &*a;
  a.edit() = 2;
  EXPECT_EQ(&*a, at);
  Shared moved = std::move(a);
  moved.edit() = 3;
  EXPECT_EQ(&*moved, at);
}

}  // namespace
}  // namespace vsgraphs
