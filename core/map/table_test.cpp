#include "core/map/table.h"

#include <gtest/gtest.h>

#include <vector>

namespace vsgraphs {
namespace {

using NumberId = Id<struct NumberTag>;
using Numbers = Table<NumberId, int, 4>;
using KeptNumbers = Table<NumberId, int, 4, false>;

NumberId add(auto& table, int value) {
  const NumberId id = table.next_id();
  table.insert_at(id, value);
  return id;
}

TEST(Table, FindsWhatWasInserted) {
  Numbers table;
  std::vector<NumberId> ids;
  for (int i = 0; i < 10; ++i) ids.push_back(add(table, i * i));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(*table.find(ids[static_cast<std::size_t>(i)]), i * i);
  EXPECT_EQ(table.size(), 10U);
  EXPECT_EQ(table.find(NumberId{}), nullptr);
}

TEST(Table, StaleIdFindsNothingWhenItsSlotIsUsedAgain) {
  Numbers table;
  const NumberId old = add(table, 1);
  table.erase(old);
  const NumberId fresh = add(table, 2);
  EXPECT_EQ(fresh.index, old.index);
  EXPECT_NE(fresh, old);
  EXPECT_EQ(table.find(old), nullptr);
  EXPECT_EQ(table.edit(old), nullptr);
  EXPECT_EQ(*table.find(fresh), 2);
}

TEST(Table, KeepsSlotsOfRemovedIdsWhereAsked) {
  KeptNumbers table;
  const NumberId old = add(table, 1);
  table.erase(old);
  EXPECT_NE(add(table, 2).index, old.index);
}

TEST(Table, ResolveFollowsMergesAndEndsWithReuse) {
  Numbers table;
  const NumberId a = add(table, 1), b = add(table, 2), c = add(table, 3);
  table.erase(a, b);
  table.erase(b, c);
  EXPECT_EQ(table.resolve(a), c);
  EXPECT_EQ(table.resolve(c), c);
  add(table, 4);  // takes a's slot
  EXPECT_FALSE(table.resolve(a).valid());
  EXPECT_EQ(table.resolve(b), c);
}

TEST(Table, CopyDoesNotSeeLaterWrites) {
  Numbers table;
  const NumberId id = add(table, 1);
  for (int i = 0; i < 7; ++i) add(table, i);
  const Numbers copy(table);
  table.seal();
  *table.edit(id) = 99;
  const NumberId later = add(table, 5);
  table.erase(NumberId{3, 0});
  EXPECT_EQ(*copy.find(id), 1);
  EXPECT_FALSE(copy.contains(later));
  EXPECT_TRUE(copy.contains(NumberId{3, 0}));
  EXPECT_EQ(*table.find(id), 99);
}

TEST(Table, PrivateCopyDoesNotWriteIntoItsOrigin) {
  Numbers table;
  const NumberId id = add(table, 1);
  Numbers copy(table);
  *copy.edit(id) = 99;
  Numbers second(copy);
  copy.seal();
  *second.edit(id) = 7;
  EXPECT_EQ(*table.find(id), 1);
  EXPECT_EQ(*copy.find(id), 99);
  EXPECT_EQ(*second.find(id), 7);
}

TEST(Table, IteratesInIdOrder) {
  Numbers table;
  for (int i = 0; i < 9; ++i) add(table, i);
  table.erase(NumberId{2, 0});
  table.erase(NumberId{0, 0});
  add(table, 100);  // takes slot 2, the first one freed
  std::vector<std::uint32_t> order;
  table.for_each([&order](NumberId id, int) { order.push_back(id.index); });
  EXPECT_EQ(order, (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(Table, AcceptsAnIdForeseenByACopyAfterRemovals) {
  Numbers table;
  for (int i = 0; i < 5; ++i) add(table, i);
  table.erase(NumberId{1, 0});
  Numbers copy(table);
  const NumberId foreseen = copy.next_id();
  table.erase(NumberId{0, 0});
  table.insert_at(foreseen, 42);
  EXPECT_EQ(*table.find(foreseen), 42);
}

TEST(Table, RefusesAnIdInUse) {
  Numbers table;
  const NumberId id = add(table, 1);
  EXPECT_THROW(table.insert_at(id, 2), InvariantError);
  EXPECT_THROW(table.insert_at(NumberId{9, 0}, 2), InvariantError);
}

}  // namespace
}  // namespace vsgraphs
