#include "core/base/bounded_queue.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace vsgraphs {
namespace {

TEST(BoundedQueue, HandsOverInOrderThroughASmallBound) {
  BoundedQueue<int> queue(2);
  std::vector<int> got;
  std::thread consumer([&] {
    while (const auto value = queue.pop()) got.push_back(*value);
  });
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(queue.push(i));
  queue.close();
  consumer.join();
  ASSERT_EQ(got.size(), 1000U);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(got[static_cast<std::size_t>(i)], i);
}

TEST(BoundedQueue, WhoMustNotWaitIsToldThatThereIsNoRoom) {
  BoundedQueue<int> queue(1);
  EXPECT_TRUE(queue.try_push(1));
  EXPECT_FALSE(queue.try_push(2));
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_TRUE(queue.try_push(3));
  EXPECT_EQ(queue.pop(), 3);
  queue.close();
  EXPECT_FALSE(queue.try_push(4));
}

TEST(BoundedQueue, ClosingWakesAProducerThatWaits) {
  BoundedQueue<int> queue(1);
  EXPECT_TRUE(queue.push(1));
  std::thread producer([&] { EXPECT_FALSE(queue.push(2)); });
  queue.close();
  producer.join();
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), std::nullopt);
  EXPECT_TRUE(queue.closed());
}

}  // namespace
}  // namespace vsgraphs
