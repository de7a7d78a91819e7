#include "core/map/follower.h"

#include <typeinfo>

namespace vsgraphs {

namespace {

const Follower* same_kind(const Follower& as, const Followers* among) {
  if (!among) return nullptr;
  for (const auto& other : among->all()) {
    const Follower& candidate = *other;
    if (typeid(candidate) == typeid(as)) return &candidate;
  }
  return nullptr;
}

}  // namespace

Followers Followers::copy() const {
  std::vector<std::shared_ptr<Follower>> copies;
  for (const auto& follower : all_) copies.push_back(follower->copy());
  return Followers(std::move(copies));
}

void Followers::follow(const Map& before, const MapEdit& edit, const Map& after, const Followers* absorbed,
                       const Guard& guard) {
  std::erase_if(all_, [&](const std::shared_ptr<Follower>& follower) {
    return !guard(follower->serves(),
                  [&] { follower->follow(before, edit, after, same_kind(*follower, absorbed)); });
  });
}

void Followers::catch_up(const Map& map, bool all, const Guard& guard) {
  std::erase_if(all_, [&](const std::shared_ptr<Follower>& follower) {
    return !guard(follower->serves(), [&] { follower->catch_up(map, all); });
  });
}

void Followers::start(const Map& map, const Followers& known) const {
  for (const auto& follower : all_) {
    const Follower* same = same_kind(*follower, &known);
    if (!same || !follower->adopt(*same)) follower->gather(map);
  }
}

}  // namespace vsgraphs
