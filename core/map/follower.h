// What is derived from a map and follows its edits: knowledge that would cost too much to gather anew each time, and that
// nobody but its follower keeps up to date. A map has its own followers; they go to sleep with it and are saved with it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/archive.h"
#include "core/map/map.h"
#include "core/map/map_checks.h"

namespace vsgraphs {

class Follower {
 public:
  virtual ~Follower() = default;

  // Names its section in an archive.
  virtual const char* name() const = 0;
  // The part of the system that it goes with: where that is switched off, nobody follows any more.
  virtual const char* serves() const = 0;

  // Every edit of its map, once and in order; `after` is `before` with the edit applied. `absorbed`: where the edit takes in
  // another map (AbsorbMap), the follower of this kind that followed the other one, or null if there was none.
  virtual void follow(const Map& before, const MapEdit& edit, const Map& after, const Follower* absorbed) = 0;
  // Does what follow() left to do, as far as its budget goes, or (`all`) everything. At fixed steps of a run.
  virtual void catch_up(const Map& /*map*/, bool /*all*/) {}
  // From the map alone, in place of what is known: where none was saved with the map.
  virtual void gather(const Map& map) = 0;

  // Goes on from what another of its kind knew of the same map, which was saved or made with other options. False, and nothing
  // is known: it does not fit; gather().
  virtual bool adopt(const Follower& known) = 0;

  virtual std::shared_ptr<Follower> copy() const = 0;
  virtual void save(ArchiveWriter& archive, const std::string& section) const = 0;
  // Throws InputError as archives do.
  virtual void load(const ArchiveReader& archive, const std::string& section) = 0;
  // A line for the user about what it had to leave out; empty: nothing.
  virtual std::string warning() const { return {}; }
  // What of it does not fit the map; nullptr if all does.
  virtual Wrong wrong_with(const Map& map) const = 0;
};

// One of each kind, in a fixed order.
class Followers {
 public:
  // Runs a piece of work of the part named; says whether it was done.
  using Guard = std::function<bool(const char* part, const std::function<void()>& work)>;

  Followers() = default;
  explicit Followers(std::vector<std::shared_ptr<Follower>> all) : all_(std::move(all)) {}

  const std::vector<std::shared_ptr<Follower>>& all() const { return all_; }
  bool empty() const { return all_.empty(); }
  Followers copy() const;

  // A follower whose part is off, or fails now, is one no more.
  void follow(const Map& before, const MapEdit& edit, const Map& after, const Followers* absorbed,
              const Guard& guard);
  void catch_up(const Map& map, bool all, const Guard& guard);
  // From what was known of the map, or where there is nothing of a kind that fits, from the map.
  void start(const Map& map, const Followers& known) const;

  // nullptr where there is none of this kind.
  template <typename Kind>
  const Kind* find() const {
    for (const auto& follower : all_) {
      if (const auto* found = dynamic_cast<const Kind*>(follower.get())) return found;
    }
    return nullptr;
  }

 private:
  std::vector<std::shared_ptr<Follower>> all_;
};

}  // namespace vsgraphs
