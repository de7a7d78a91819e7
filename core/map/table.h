// The only container of the map: values by generational id, iterated in id order, with copy-on-write chunks so
// that a copy costs one pointer per chunk and shares everything that has not changed since.
//
// Who may write: the one owner of a table, and whoever holds a private copy of it. A chunk is written in place
// only if it was made in the table's present epoch; `seal()` starts the next one and is called by the owner each
// time it has handed out a copy. No reference counts are read, so there is nothing to race on.
#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <type_traits>
#include <vector>

#include "core/base/check.h"
#include "core/base/fields.h"
#include "core/map/ids.h"

namespace vsgraphs {

// `reuse_slots` is off where removed ids must stay answerable for ever (keyframes: frames are anchored to them).
template <typename IdType, typename Value, std::uint32_t chunk_size, bool reuse_slots = true>
class Table {
 public:
  Table() = default;
  Table(const Table& other)
      : chunks_(other.chunks_),
        free_(other.free_),
        slots_(other.slots_),
        size_(other.size_),
        epoch_(other.epoch_ + 1) {}
  Table& operator=(const Table& other) {
    Table copy(other);
    std::swap(*this, copy);
    return *this;
  }
  Table(Table&&) noexcept = default;
  Table& operator=(Table&&) noexcept = default;
  ~Table() = default;

  // After this, chunks that copies share are no longer written in place.
  void seal() { ++epoch_; }

  std::uint32_t size() const { return size_; }

  // nullptr where the id is stale or was never given out.
  const Value* find(IdType id) const {
    const Slot* slot = slot_of(id.index);
    return slot && slot->alive && slot->generation == id.generation ? &slot->value : nullptr;
  }
  bool contains(IdType id) const { return find(id) != nullptr; }

  // The id living at an index, or an invalid one.
  IdType at_index(std::uint32_t index) const {
    const Slot* slot = slot_of(index);
    return slot && slot->alive ? IdType{index, slot->generation} : IdType{};
  }

  // The living ones of the lowest and the highest index; invalid where none lives.
  IdType first() const {
    for (std::uint32_t index = 0; index < slots_; ++index)
      if (const IdType id = at_index(index); id.valid()) return id;
    return {};
  }
  IdType last() const {
    for (std::uint32_t index = slots_; index-- > 0;)
      if (const IdType id = at_index(index); id.valid()) return id;
    return {};
  }

  // Follows what a removed id was merged into; an invalid id where it vanished for good. The trail is kept until
  // the slot is used again, which the first-in-first-out free list delays for as long as it can.
  IdType resolve(IdType id) const {
    for (int hops = 0; hops < 16; ++hops) {
      const Slot* slot = slot_of(id.index);
      if (!slot) return {};
      if (slot->alive) return slot->generation == id.generation ? id : IdType{};
      if (slot->generation != id.generation || !slot->redirect.valid()) return {};
      id = slot->redirect;
    }
    return {};
  }

  // The id the next insert will get if nothing else happens in between.
  IdType next_id() const {
    if (free_.empty()) return {slots_, 0};
    return {free_.front(), slot_of(free_.front())->generation + 1};
  }

  // Puts a value at an id obtained from next_id() of this table or of a copy that has seen the same history of
  // inserts (removals in between are fine).
  void insert_at(IdType id, Value value) {
    VSG_INVARIANT(id.valid() && id.index <= slots_);
    if (id.index == slots_) {
      if (id.index / chunk_size >= chunks_.size()) chunks_.resize(id.index / chunk_size + 1);
      if (!chunks_[id.index / chunk_size]) chunks_[id.index / chunk_size] = std::make_shared<Chunk>(epoch_);
      ++slots_;
    } else {
      auto position = free_.begin();
      while (position != free_.end() && *position != id.index) ++position;
      VSG_INVARIANT(position != free_.end());
      free_.erase(position);
    }
    Slot& slot = writable(id.index);
    VSG_INVARIANT(!slot.alive);
    slot.alive = true;
    slot.generation = id.generation;
    slot.redirect = {};
    slot.value = std::move(value);
    ++size_;
  }

  // New slots get indices from `index` on, if they have not come that far; what is passed over costs a null pointer per
  // chunk. Slots that are free already are used as ever.
  void start_at(std::uint32_t index) { slots_ = std::max(slots_, index); }

  // Takes in all of a table of which no index was ever in use here, ids and trails included. Chunks are shared where
  // only one of the two has any. Cost: one step per chunk.
  void absorb(const Table& other) {
    if (chunks_.size() < other.chunks_.size()) chunks_.resize(other.chunks_.size());
    // Later than the epoch of any chunk of either: none is written in place.
    epoch_ = std::max(epoch_, other.epoch_) + 1;
    for (std::size_t c = 0; c < other.chunks_.size(); ++c) {
      if (!other.chunks_[c]) continue;
      if (!chunks_[c]) {
        chunks_[c] = other.chunks_[c];
      } else {
        take_over(*other.chunks_[c], static_cast<std::uint32_t>(c) * chunk_size);
      }
    }
    free_.insert(free_.end(), other.free_.begin(), other.free_.end());
    slots_ = std::max(slots_, other.slots_);
    size_ += other.size_;
  }

  // nullptr like find(); the value may be changed through the pointer until the next call that copies the table.
  Value* edit(IdType id) { return contains(id) ? &writable(id.index).value : nullptr; }

  void erase(IdType id, IdType redirect = {}) {
    if (!contains(id)) return;
    Slot& slot = writable(id.index);
    slot.alive = false;
    slot.redirect = redirect;
    slot.value = Value{};
    if constexpr (reuse_slots) free_.push_back(id.index);
    --size_;
  }

  template <typename Visit>
  void for_each(Visit&& visit) const {
    for (std::uint32_t index = 0; index < slots_; ++index) {
      const Slot* slot = slot_of(index);
      if (slot && slot->alive) visit(IdType{index, slot->generation}, slot->value);
    }
  }

  // The whole history that later ids depend on: generations, redirects, the order in which slots are used again.
  template <FieldsOf<Table> T>
  friend void visit_fields(T& table, auto& field) {
    constexpr bool reads = std::remove_reference_t<decltype(field)>::reads;
    std::uint64_t chunks = table.chunks_.size();
    if constexpr (reads) {
      table = Table();
      chunks = field.count(1);
    } else {
      field(chunks);
    }
    for (std::uint64_t c = 0; c < chunks; ++c) {
      if constexpr (reads) table.chunks_.emplace_back();
      auto& chunk = table.chunks_[c];
      bool used = chunk != nullptr;
      field(used);
      if (!used) continue;
      if constexpr (reads) chunk = std::make_shared<Chunk>(table.epoch_);
      for (auto& slot : std::conditional_t<reads, Chunk&, const Chunk&>(*chunk).slots)
        visit_slot(slot, field);
    }
    field(table.slots_, table.free_);
    if constexpr (reads) field.require(table.count_and_check(), "slots that do not fit together");
  }

  // One more than the largest index in use: the length of an array indexed by id.index.
  std::uint32_t index_bound() const { return slots_; }

 private:
  struct Slot {
    Value value{};
    IdType redirect{};
    std::uint32_t generation = 0;
    bool alive = false;
  };
  struct Chunk {
    explicit Chunk(std::uint64_t e) : epoch(e) {}
    std::uint64_t epoch;
    std::array<Slot, chunk_size> slots{};
  };

  static void visit_slot(auto& slot, auto& field) {
    field(slot.generation, slot.alive);
    if (slot.alive)
      field(slot.value);
    else
      field(slot.redirect);
  }
  // After reading: every living slot has an index that was given out, and what is free is there, dead, and free once.
  bool count_and_check() {
    constexpr std::uint32_t most_slots = 1U << 26;
    if (slots_ > most_slots) return false;
    size_ = 0;
    for_each([this](IdType, const Value&) { ++size_; });
    std::uint64_t alive = 0;
    for (const auto& chunk : chunks_) {
      for (std::uint32_t i = 0; chunk && i < chunk_size; ++i) alive += chunk->slots[i].alive ? 1 : 0;
    }
    std::vector<bool> free(slots_, false);
    for (const std::uint32_t index : free_) {
      const Slot* slot = slot_of(index);
      if (!reuse_slots || !slot || slot->alive || free[index]) return false;
      free[index] = true;
    }
    return alive == size_;
  }

  const Slot* slot_of(std::uint32_t index) const {
    if (index >= slots_ || index / chunk_size >= chunks_.size() || !chunks_[index / chunk_size])
      return nullptr;
    return &chunks_[index / chunk_size]->slots[index % chunk_size];
  }
  Slot& writable(std::uint32_t index) {
    std::shared_ptr<Chunk>& chunk = chunks_[index / chunk_size];
    if (chunk->epoch != epoch_) {
      chunk = std::make_shared<Chunk>(*chunk);
      chunk->epoch = epoch_;
    }
    return chunk->slots[index % chunk_size];
  }

  void take_over(const Chunk& chunk, std::uint32_t first_index) {
    for (std::uint32_t i = 0; i < chunk_size; ++i) {
      const Slot& slot = chunk.slots[i];
      if (!slot.alive && slot.generation == 0 && !slot.redirect.valid()) continue;
      Slot& mine = writable(first_index + i);
      VSG_INVARIANT(!mine.alive);
      mine = slot;
    }
  }

  std::vector<std::shared_ptr<Chunk>> chunks_;  // null where no index was ever in use
  std::deque<std::uint32_t> free_;
  std::uint32_t slots_ = 0;
  std::uint32_t size_ = 0;
  std::uint64_t epoch_ = 0;
};

}  // namespace vsgraphs
