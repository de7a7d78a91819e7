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

TEST(Table, KnowsItsFirstAndItsLast) {
  Numbers table;
  EXPECT_FALSE(table.first().valid());
  EXPECT_FALSE(table.last().valid());
  table.start_at(20);
  const NumberId a = add(table, 1), b = add(table, 2), c = add(table, 3);
  EXPECT_EQ(table.first(), a);
  EXPECT_EQ(table.last(), c);
  table.erase(a, b);
  table.erase(c, b);
  EXPECT_EQ(table.first(), b);
  EXPECT_EQ(table.last(), b);
}

TEST(Table, StartsAtAnIndexAndKnowsNothingBelow) {
  Numbers table;
  table.start_at(1000003);
  const NumberId first = add(table, 7), second = add(table, 8);
  EXPECT_EQ(first.index, 1000003U);
  EXPECT_EQ(second.index, 1000004U);
  EXPECT_EQ(table.size(), 2U);
  EXPECT_EQ(table.find({0, 0}), nullptr);
  EXPECT_EQ(table.find({1000002, 0}), nullptr) << "in the first one's chunk";
  EXPECT_FALSE(table.at_index(5).valid());
  EXPECT_FALSE(table.resolve({5, 0}).valid());
  int visited = 0;
  table.for_each([&](NumberId id, int value) { visited += value * (id.index > 1000000U); });
  EXPECT_EQ(visited, 15);
  table.start_at(10);
  EXPECT_EQ(add(table, 9).index, 1000005U) << "never goes back";
}

TEST(Table, FreeSlotsAreUsedBeforeANewStart) {
  Numbers table;
  const NumberId old = add(table, 1);
  table.erase(old);
  table.start_at(100);
  EXPECT_EQ(add(table, 2).index, old.index);
  EXPECT_EQ(add(table, 3).index, 100U);
}

TEST(Table, AbsorbsATableOfOtherIdsAndTouchesNeither) {
  Numbers a, b;
  std::vector<NumberId> in_a, in_b;
  for (int i = 0; i < 6; ++i) in_a.push_back(add(a, i));
  b.start_at(6);  // the second chunk holds values of both
  for (int i = 0; i < 9; ++i) in_b.push_back(add(b, 100 + i));
  a.start_at(b.index_bound());
  for (int i = 6; i < 9; ++i) in_a.push_back(add(a, i));
  b.erase(in_b[0], in_b[1]);
  b.erase(in_b[4]);

  Numbers both = a;
  both.absorb(b);
  EXPECT_EQ(both.size(), a.size() + b.size());
  for (const NumberId id : in_a) EXPECT_EQ(*both.find(id), *a.find(id));
  for (const NumberId id : in_b) EXPECT_EQ(both.contains(id), b.contains(id));
  EXPECT_EQ(both.resolve(in_b[0]), in_b[1]) << "trails come along";

  for (const NumberId id : in_a) *both.edit(id) = -1;
  for (const NumberId id : in_b)
    if (int* value = both.edit(id)) *value = -1;
  EXPECT_EQ(*a.find(in_a[3]), 3);
  EXPECT_EQ(*b.find(in_b[8]), 108);
  EXPECT_EQ(add(both, 1).index, in_b[0].index) << "free slots come along";
  EXPECT_EQ(add(both, 2).index, in_b[4].index);
  EXPECT_EQ(add(both, 3).index, a.index_bound());
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
